// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../where/places.hpp"
#include "../which/doubt.hpp"
#include "../which/late_velocity.hpp"
#include "../which/shadow.hpp"

#include <algorithm>
#include <numeric>
#include <string>

namespace quadrant::inline v0::diagnosis::detail {

/// One block and no hold-out log: nothing is left to test a cause on that was not fitted.
inline bool untested(const axis_case& c) { return !c.second && c.record.segments < 2; }

/// A value that the tolerance stopped: either the tolerance is too narrow, or something else acts.
inline void note_bounds(diagnosis_result& out, const axis_result& result) {
    for (const parameter_estimate& p : result.calibrated) {
        if (!p.on_bound) continue;
        std::string name(parts_of(p.key.substr(p.key.rfind('.') + 1)).stem);
        std::replace(name.begin(), name.end(), '_', ' ');
        out.notes.push_back(
            worded("axis %s: the calibrated %s stops at the end of its tolerance: the tolerance "
                   "is too narrow, or an effect acts that is not named.",
                   result.name.c_str(), name.c_str()));
    }
}

/// A measured command most of whose variation lies above the band in which forces are judged.
inline void note_above_band(diagnosis_result& out, const axis_case& c) {
    if (c.axis.actuator.command_is != command_origin::measured || c.axis.drive.closes()) return;
    const axis_record& r = c.record;
    std::vector<double> all(r.command.begin(), r.command.end());
    const double mean = std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
    for (double& u : all) u -= mean;
    const double share = 1 - square(rms(zero_phase(all, r.bandwidth_Hz, r.period)) / rms(all));
    if (share > 0.5)
        out.notes.push_back(fmt::format("axis {}: {:.0f} % of the command's variation (in energy) lies above "
                                        "the {:.3g} Hz up to which forces are "
                                        "judged: nothing is said of what makes it.",
                                        c.axis.name, 100 * share, r.bandwidth_Hz));
}

/// Positions whose steps are those of the log's last digit.
inline void note_digits(diagnosis_result& out, const axis_case& c) {
    if (c.coarse() && c.counts_digits())
        out.notes.push_back(text_of(
            fmt::format(
                "axis {}: the positions are written in steps of {:.3g} m, the last digit of the log, and "
                "{:.3g} m are described: write more digits, or nothing says what the encoder counts in.",
                c.axis.name, c.count, c.axis.encoder.resolution_m),
            c.axis.kind));
}

/// What was left out because the hold-out log speaks against it.
inline void note_denied(diagnosis_result& out, const axis_case& c) {
    for (const effect* e : c.denied())
        out.notes.push_back(fmt::format(
            "axis {}: {} would take more off this log's gap, but with it the causes predict the hold-out log "
            "worse than none: it is left out. It may be real in this motion alone.",
            c.axis.name, label_of(*e)));
}

/// A controller whose integral is not limited as the file's kind limits it.
inline void note_limit(diagnosis_result& out, const axis_case& c) {
    if (c.controller && c.controller->limits_otherwise_from)
        out.notes.push_back(fmt::format(
            "axis {}: behind a time at its limit, first at {:.4g} s, the controller's integral is another "
            "than the described kind's: it is limited otherwise. Nothing else of the controller differs.",
            c.axis.name, *c.controller->limits_otherwise_from));
}

/// A friction along the travel that what is late makes of a cogging.
inline void note_shadow(diagnosis_result& out, const axis_case& c) {
    for (const effect* e : c.best().effects)
        if (is_shadow_of_cogging(c, *e))
            out.notes.push_back(fmt::format(
                "axis {}: the {} has the period of the cogging and lies a quarter of it aside, as where force "
                "and position are a little late against one another: record both at one moment.",
                c.axis.name, label_of(*e)));
}

/// Two forces over the position of which little is left together.
inline void note_cancelled(diagnosis_result& out, const axis_case& c) {
    for (const effect* e : c.best().effects) {
        const effect* other = cancelled_by(c, *e);
        if (!other) continue;
        out.notes.push_back(fmt::format(
            "axis {}: {} and {} cancel here: together they are smaller than either. Any curve over the "
            "position looks like two such forces.",
            c.axis.name, label_of(*e), label_of(*other)));
        return;
    }
}

/// A claim beside a play, with which the simulated loop comes no nearer to its log row by row.
inline void note_chatter(diagnosis_result& out, const axis_case& c, const axis_result& result) {
    if (c.claims == 0 || !c.applied().fit.plant.has_play() ||
        !(result.gap_after.position_rms_m > result.gap.position_rms_m))
        return;
    out.notes.push_back(fmt::format(
        "axis {}: row by row the position of the simulated loop comes no nearer to the logged one. With a play "
        "a loop may chatter, at other moments than its machine.",
        c.axis.name));
}

/// A delay that is another by whole rows: columns that were not recorded together look the same, and without a
/// described controller nothing says which it is.
inline void note_rows_of_delay(diagnosis_result& out, const axis_case& c, const std::vector<cause>& causes) {
    if (c.controller) return;
    for (const cause& x : causes) {
        if (x.effect != "time_delay" || !claimed(x) || x.parameters.empty()) continue;
        const double more =
            (x.parameters.front().values.front().value - c.axis.plant.delay_s) / c.record.period;
        const double rows = std::round(more);
        if (rows == 0 || std::abs(more - rows) > 0.15) continue;
        out.notes.push_back(fmt::format(
            "axis {}: the delay is {} by {} of the log. A position that was recorded that much {}, or a "
            "command that was "
            "recorded that much {}, looks the same: describe the controller, and its replay decides.",
            x.axis, rows > 0 ? "longer" : "shorter",
            std::abs(rows) == 1 ? "one row" : fmt::format("{:.0f} rows", std::abs(rows)),
            rows > 0 ? "late" : "early", rows > 0 ? "early" : "late"));
    }
}

/// Set-points that seem to come early.
inline void note_late_velocity(diagnosis_result& out, const axis_case& c, const std::vector<cause>& causes) {
    for (const cause& x : causes)
        if (const double earlier = late_velocity(c, x); earlier > 0)
            out.notes.push_back(fmt::format(
                "axis {}: set-points that come {:.2g} ms earlier than described may as well be a velocity that "
                "the drive measures as much late. Read the filter of its velocity, and write "
                "drive.velocity_filter_Hz.",
                c.axis.name, 1e3 * earlier));
}

/// What the owner excludes although it explains the record better than what is named.
inline void note_excluded(diagnosis_result& out, const std::vector<cause>& causes) {
    for (const cause& x : causes)
        if (!x.better_excluded.empty())
            out.notes.push_back(fmt::format("axis {}: {}, which the machine file excludes, explains the record "
                                            "better than {} does: check excluded_effects.",
                                            x.axis, label_of_effect(x.better_excluded),
                                            label_of_effect(x.effect)));
}

/// What the search did not come to before its time was up.
inline void note_missed(diagnosis_result& out, const axis_case& c) {
    if (!c.models.over()) return;
    std::string names;
    for (const effect* e : c.models.suspects())
        if (c.models.missed().contains(e)) (names += names.empty() ? "" : ", ") += label_of(*e);
    const std::string what = !names.empty()   ? "not tried beside what was found: " + names
                             : c.models.cut() ? "a further cause may be missing"
                                              : "no motion was searched for that would tell more";
    out.notes.push_back(fmt::format("axis {}: the time was up: {}.", c.axis.name, what));
}

} // namespace quadrant::inline v0::diagnosis::detail
