// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "chain/diagnose_chain.hpp"
#include "effect/effect_list.hpp"
#include "fit/both_motions.hpp"
#include "fit/neighbour.hpp"
#include "fit/turned_beam.hpp"
#include "fit/with_drives.hpp"
#include "log/thinned.hpp"
#include "next/blind_spots.hpp"
#include "text/bad_input.hpp"
#include "verdict/diagnose_axis.hpp"
#include "verdict/own_words.hpp"
#include "where/columns_in_time.hpp"
#include "where/places.hpp"
#include "which/looks.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// An axis of which nothing but positions is known.
inline void diagnose_positions(diagnosis_result& out, const axis_description& axis, const axis_log& log,
                               const machine_description& machine, const std::string& file, const rules& r) {
    std::vector<cause> causes;
    axis_result result = chain::diagnose_positions(out, causes, axis, log, machine.sample_period_s, file,
                                                   machine.excluded_effects, r);
    put_in_words(result.kind, result.where);
    put_in_words(result.kind, result.calibrated);
    put_in_words(result.kind, causes);
    out.verdict = std::max(out.verdict, result.verdict);
    if (result.verdict > verdict::within_tolerance)
        out.causes.insert(out.causes.end(), causes.begin(), causes.end());
    const auto unseen = unseen_by(result, causes);
    out.not_seen.insert(out.not_seen.end(), unseen.begin(), unseen.end());
    out.axes.push_back(std::move(result));
}

/// Whether two encoders are recorded whose difference shows the transmission.
inline bool shows_transmission(const axis_description& axis, const axis_log& log) {
    return !log.motor.empty() && (axis.transmission != transmission_description{} || log.motor_unit == "rad");
}

/// The rules with this axis' share of the time that is left for `axes`.
inline rules for_one_of(rules r, std::ptrdiff_t axes) {
    if (r.until != rules::clock::time_point::max()) {
        const auto now = r.now();
        r.until = now + (r.until - now) / axes;
    }
    return r;
}

/// How many rows of a long record are taken as one. A measured command is not replayed, and no cause lies
/// within a row of it: such a record needs no more rows than its time scale does. A described controller needs
/// its own period, in which the corrected loop is simulated.
inline std::size_t rows_in_one(const axis_description& axis, const axis_log& log, double period,
                               const rules& r) {
    if (axis.actuator.command_is != command_origin::measured || axis.controller || axis.drive.closes())
        return 1;
    const double corner = bandwidth_of(axis, log, period) / record_scales{.corner_Hz = 1}.bandwidth_Hz();
    return std::clamp<std::size_t>(log.position.size() / r.rows_of_a_look, 1,
                                   diagnosis::rows_in_one(corner, period));
}

/// Effects of the caller's own have names of their own.
inline void add_own_effects(std::vector<std::string>& names, const axis_description& axis) {
    const auto& own = axis.own_effects;
    for (auto e = own.begin(); e != own.end(); ++e) {
        const auto refuse = [&](const std::string& why) {
            throw std::invalid_argument(fmt::format("own_effects of axis {}: {}", axis.name, why));
        };
        if (!*e || !(*e)->starts || !(*e)->read) refuse("one is null, or has no starts or no reading");
        const std::string_view name = (*e)->name;
        if (effect_named(name)) refuse(fmt::format("{} is a name of the list", name));
        if (std::any_of(own.begin(), e, [&](const effect* before) { return before->name == name; }))
            refuse(fmt::format("{} is there twice", name));
        if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
    }
}

/// Log and hold-out log as they were read, and with what a drive's columns say.
struct read_logs {
    read_logs(const machine_description& m, const machine_log& l, const machine_log* second)
        : machine(m), as_read(l), as_read_too(second), log(with_drives(m, l)) {
        if (second) with_drives_too = with_drives(m, *second);
    }
    const machine_log* holdout() const { return with_drives_too ? &*with_drives_too : nullptr; }

    const machine_description& machine;
    const machine_log& as_read;
    const machine_log* as_read_too;
    machine_log log;
    std::optional<machine_log> with_drives_too;
};

/// An axis and what of the logs its models are fitted to.
struct ready_axis {
    ready_axis(const axis_description& a, const axis_log& logged, const read_logs& logs, const rules& r,
               std::vector<std::string>& notes);

    axis_description axis;
    double period;
    std::optional<chain::two_encoders> transmission{};
    axis_log log{};                    ///< that of the axis with its neighbour's motion
    std::optional<axis_log> holdout{}; ///< the same of the hold-out log
    other_axes others{};
    /// A servo's law on duty is soft, and a force moves it where it shows. A stiff loop hides it from the path.
    bool soft = false;
    std::optional<axis_log> both{}; ///< six seconds of it hold a dozen readings: none to spare for a test

private:
    void thin(double band, const rules& r, std::vector<std::string>& notes);
};

inline ready_axis::ready_axis(const axis_description& a, const axis_log& logged, const read_logs& logs,
                              const rules& r, std::vector<std::string>& notes)
    : axis(as_logged(a, logged)), period(logs.machine.sample_period_s) {
    if (axis.controller && !axis.drive.closes() && axis.actuator.command_is == command_origin::measured)
        notes.push_back(worded("axis %s: the command was measured behind the amplifier; what the controller "
                               "asked for is not in the log, and nothing is said of the controller.",
                               axis.name.c_str()));
    if (shows_transmission(axis, logged))
        transmission =
            chain::diagnose_transmission(axis, logged, period, logs.log.file, logs.machine.excluded_effects, r);
    const axis_log& at_motor = transmission ? transmission->carried : logged;
    for (std::string& note : told_by_turn(axis, at_motor, period)) notes.push_back(std::move(note));
    const double band = bandwidth_of(axis, at_motor, period);
    log = with_neighbour(logs.log, at_motor, period, band);
    const machine_log* const second = logs.holdout();
    if (const auto found = second ? named(second->axes, axis.name) : nullptr)
        holdout = with_neighbour(
            *second,
            transmission ? chain::carried_too(*transmission, axis, *found, period, second->file) : *found,
            period, band);
    for (const auto* axes : {&logs.log.axes, &logs.log.beside})
        for (const axis_log& each : *axes) others.logs.push_back(&each);
    put_columns_in_time(axis, period, log, holdout, notes);
    thin(band, r, notes);
    soft = axis.drive.kind == drive_kind::position_servo && at_motor.drive;
    if (soft && holdout && !transmission)
        both = both_motions(axis, *named(logs.as_read.axes, axis.name),
                            *named(logs.as_read_too->axes, axis.name), logs.machine.sample_period_s);
}

inline void ready_axis::thin(double band, const rules& r, std::vector<std::string>& notes) {
    const std::size_t n = rows_in_one(axis, log, period, r);
    if (n < 2) return;
    others.rows_in_one = n;
    notes.push_back(fmt::format("axis {}: {} samples of {:.4g} s are taken as one: the record is long, its "
                                "command is measured, and above {:.3g} Hz the noise of the position hides the "
                                "forces.",
                                axis.name, n, period, 0.6 * band));
    log = thinned(log, n);
    if (holdout) holdout = thinned(*holdout, n);
    period *= static_cast<double>(n);
}

/// An axis whose forces are known.
inline void diagnose_forces(diagnosis_result& out, ready_axis& ready, const read_logs& logs,
                            const progress& tell, const rules& limits) {
    const axis_description& axis = ready.axis;
    add_own_effects(out.own_effects, axis);
    if (axis.controller && axis.controller->own) // its file's kind is known after all
        std::erase_if(out.notes, [&](const std::string& note) {
            return note.starts_with(fmt::format("axis {}: controller kind ", axis.name));
        });
    exclusions excluded{logs.machine.excluded_effects};
    if (ready.transmission) excluded.by_readings = {"backlash", "structural_resonance"}; // of the two encoders
    const axis_description rigid = ready.transmission ? ready.transmission->rigid(axis) : axis;
    const stages stage =
        stages_of(axis.actuator.command_is == command_origin::measured && !axis.drive.closes());
    const auto found = look_at({.axis = rigid,
                                .log = ready.both ? *ready.both : ready.log,
                                .apart = ready.log,
                                .holdout = ready.holdout ? &*ready.holdout : nullptr,
                                .both = ready.both.has_value(),
                                .soft = ready.soft,
                                .period = ready.period,
                                .excluded = excluded,
                                .limits = limits,
                                .stage = stage},
                               logs.log.file, tell, out.notes);
    if (found->exchanged) ready.others.logs.clear(); // they are of the other log
    diagnose_axis(out, *found, tell, stage, ready.transmission ? &*ready.transmission : nullptr, ready.others);
    tell("axis " + axis.name + ": done", 1);
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL diagnosis_result diagnose(const machine_description& machine,
                                                  const machine_log& as_read, const machine_log* as_read_too,
                                                  const progress& tell, const rules& r) {
    diagnosis_result out;
    const detail::read_logs logs(machine, as_read, as_read_too);
    const machine_log* const holdout = logs.holdout();
    out.machine_file = machine.file;
    out.log_file = logs.log.file;
    if (holdout) out.holdout_file = holdout->file;
    out.notes = machine.notes;
    out.notes.insert(out.notes.end(), logs.log.notes.begin(), logs.log.notes.end());
    if (holdout) out.notes.insert(out.notes.end(), holdout->notes.begin(), holdout->notes.end());
    const auto moved = [&](const axis_description& axis) {
        const axis_log* const logged = detail::named(logs.log.axes, axis.name);
        return logged && !logged->still ? logged : nullptr;
    };
    auto axes_left = std::count_if(machine.axes.begin(), machine.axes.end(), moved);
    const auto all_axes = static_cast<double>(axes_left);
    for (const axis_description& axis : machine.axes) {
        const axis_log* const logged = moved(axis);
        if (!logged) continue;
        const auto behind = all_axes - static_cast<double>(axes_left);
        const progress of_axis = tell.part(behind / all_axes, (behind + 1) / all_axes);
        of_axis("axis " + axis.name + ": " + std::to_string(logs.log.samples) + " samples");
        if (!axis.positions_only) {
            detail::ready_axis ready(axis, *logged, logs, r, out.notes);
            detail::diagnose_forces(out, ready, logs, of_axis, detail::for_one_of(r, axes_left--));
            continue;
        }
        detail::diagnose_positions(out, axis, *logged, machine, logs.log.file,
                                   detail::for_one_of(r, axes_left--));
        if (holdout)
            out.notes.push_back(fmt::format(
                "axis {}: the hold-out log is not used where only positions are known.", axis.name));
    }
    tell("done", 1);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
