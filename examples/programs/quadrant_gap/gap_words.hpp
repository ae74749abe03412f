// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "quadrant/diagnosis/fit/scoring.hpp"
#include "words.hpp"

/// What is left of a gap, what took it off, and what to record next.
namespace quadrant_gap {

/// What the causes leave of the gap. In energy: 1 % of it is a tenth of the rms value.
inline std::string unexplained_share(const diagnosis_result& d) {
    const bool open = d.verdict > verdict::explained,
               sure = std::all_of(d.causes.begin(), d.causes.end(), claimed);
    if (!(d.share_unexplained > 0))
        return !open  ? "Nothing that matters."
               : sure ? "Only what is slow and smaller than the noise of a row."
                      : "With the suspects added, nothing that matters.";
    return fmt::format("{} of the gap's energy (the square of its rms value) stays unexplained.",
                       d.share_unexplained < 0.005 ? "Less than 1 %" : percent(d.share_unexplained));
}

inline std::string experiment_gain(const experiment& e) {
    if (e.expected_gain <= 0) return "";
    const double score = e.expected_gain / score_temperature; // as the probabilities are weighed
    return fmt::format("Expected to separate them by a log-score of {} or more, odds of {} to 1.",
                       number(e.expected_gain), score > 7 ? "more than 1000" : number(std::exp(score)));
}

/// What is said below the motion, a sentence a line.
inline std::vector<std::string> experiment_lines(const experiment& e) {
    std::vector<std::string> out;
    if (!e.separates.empty() && !e.motion.starts_with("none"))
        out.push_back(fmt::format("{} {}{}.", e.expected_gain > 0 ? "It separates" : "It is meant to separate",
                                  named(e.separates, "and"), e.axis.empty() ? "" : ", axis " + e.axis));
    if (e.expected_gain > 0) out.push_back(experiment_gain(e));
    if (!e.finding.empty()) out.push_back(capital(e.finding) + ".");
    return out;
}

inline bool closed_loop(const axis_result& a) { return !a.signals.simulated_position_before.empty(); }

struct gap_row {
    std::string name, before, after, floor;
};

/// The gap that a cause takes off, before and after: in force, or where two positions were compared, in
/// position.
inline std::string gap_of(const cause& c, const axis_voice& voice) {
    if (c.gap_before_force_rms_N.value == 0 && c.gap_before_position_rms_m.value > 0)
        return "position gap " +
               change(c.gap_before_position_rms_m.value, c.gap_after_position_rms_m.value, voice("m"));
    return voice("force") + " gap " +
           change(c.gap_before_force_rms_N.value, c.gap_after_force_rms_N.value, voice("N"));
}

/// In the order in which an engineer asks; a row is in the unit of its first number.
inline std::vector<gap_row> gap_rows(const axis_result& a) {
    const gap_numbers &b = a.gap, &c = a.gap_after;
    const axis_voice voice = voice_of(a);
    const auto row = [&](std::string_view name, double before, double after, const std::string& unit) {
        const scale s = scale_of(unit, before);
        return gap_row{voice(name), fmt::format("{} {}", number(before * s.factor), s.unit),
                       fmt::format("{} {}", number(after * s.factor), s.unit), ""};
    };
    if (a.positions_only) {
        std::vector<gap_row> of_positions{
            row("position, rms", b.position_rms_m, c.position_rms_m, voice("m")),
            row("position, peak", b.position_peak_m, c.position_peak_m, voice("m"))};
        of_positions[0].floor = quantity_beside(b.position_rms_m, b.noise_floor_position_rms_m, voice("m"));
        return of_positions;
    }
    std::vector<gap_row> rows{row("force, rms", b.force_rms_N, c.force_rms_N, voice("N"))};
    rows[0].floor = quantity_beside(b.force_rms_N, b.noise_floor_force_rms_N, voice("N"));
    if (!closed_loop(a)) return rows;
    rows.push_back(row("position, rms", b.position_rms_m, c.position_rms_m, voice("m")));
    rows.push_back(row("position, peak", b.position_peak_m, c.position_peak_m, voice("m")));
    rows.push_back(row("command, rms", b.command_rms_V, c.command_rms_V, voice.in_command_unit("V")));
    return rows;
}

inline std::string gap_basis(const axis_result& a) {
    if (a.positions_only)
        return fmt::format("Difference of two positions, judged on {}. Nothing is known of forces.",
                           a.evaluated_on);
    return voice_of(a)("Residual force ") +
           fmt::format(
               "up to {}{}{}.{}", quantity(a.gap.bandwidth_Hz, "Hz"),
               a.evaluated_on.empty() ? "" : ", judged on ", a.evaluated_on,
               closed_loop(a) ? "" : " No closed loop was simulated: there are no position and command gaps.");
}

inline constexpr std::pair<std::string_view, std::string_view> views[] = {
    {"block", "by box of the loop"},
    {"readings", "between the two encoders"},
    {"velocity", "by velocity"},
    {"reversal", "at reversals"},
    {"position", "along the travel"},
    {"time", "in time"},
    {"frequency", "by frequency"},
    {"acceleration", "by acceleration"},
    {"other_axis", "by the motion of the other axis"},
};

} // namespace quadrant_gap
