// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "summary.hpp"

#include <quadrant/diagnosis/simulate.hpp>

/// What a simulation leaves, as text for a terminal of 100 columns.
namespace quadrant_gap {

inline std::string sentence(const simulated_axis& a) {
    std::string text =
        fmt::format("Axis {}: {} of force remain where sensor noise and rounding leave {}", a.name,
                    quantity(a.gap.force_rms_N, "N"), quantity(a.gap.noise_floor_force_rms_N, "N"));
    if (a.closed_loop)
        text += fmt::format("; the simulated loop is {} rms beside the machine",
                            quantity(a.gap.position_rms_m, "m"));
    return text_of(text + ".", a.kind);
}

inline std::vector<std::pair<std::string, std::string>> gap_rows(const simulated_axis& a) {
    const axis_voice voice{a.kind, a.command_unit};
    const std::string force = voice("N"), length = voice("m");
    std::vector<std::pair<std::string, std::string>> rows{
        {voice("force, rms"), quantity(a.gap.force_rms_N, force)},
        {voice("force, floor"), quantity(a.gap.noise_floor_force_rms_N, force)}};
    if (!a.closed_loop) return rows;
    rows.emplace_back("position, rms", quantity(a.gap.position_rms_m, length));
    rows.emplace_back("position, peak", quantity(a.gap.position_peak_m, length));
    rows.emplace_back("command, rms", quantity(a.gap.command_rms_V, voice.in_command_unit("V")));
    return rows;
}

inline std::string gap_basis(const simulated_axis& a) {
    return fmt::format("{} up to {}.{}", text_of("Residual force", a.kind), quantity(a.gap.bandwidth_Hz, "Hz"),
                       a.closed_loop ? ""
                                     : " No controller is described: there are no position and command gaps.");
}

inline std::string summary(const simulation_result& s, bool verbose) {
    std::string text = wrapped(fmt::format("{} as {} predicts it", s.log_file, s.machine_file), 0) + "\n";
    for (const simulated_axis& a : s.axes) {
        text += wrapped(sentence(a), 0) + wrapped(gap_basis(a), 2);
        for (const auto& [name, value] : gap_rows(a)) text += "  " + padded(name, 18) + value + "\n";
        for (const place& p : a.where)
            if (verbose) text += wrapped(percent(p.share) + " " + p.finding, 4);
        text += "\n";
    }
    for (const std::string& note : s.notes) text += wrapped("Note: " + note, 0);
    return text;
}

} // namespace quadrant_gap
