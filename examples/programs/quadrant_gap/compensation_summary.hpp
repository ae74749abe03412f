// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "summary.hpp"

#include <quadrant/diagnosis/compensate.hpp>

#include <algorithm>
#include <utility>

/// What compensations would gain, as text for a terminal of 100 columns.
namespace quadrant_gap {

/// "3.5 µm (3.0 to 4.1)".
inline std::string ranged(const estimate& e, std::string_view unit) {
    const scale s = scale_of(unit, e.value);
    return fmt::format("{} ({} to {})", with_unit(number(e.value * s.factor), s.unit), number(e.low * s.factor),
                       number(e.high * s.factor));
}

/// key = value, each as it goes into the controller.
inline std::string settings(const std::vector<key_value>& keys) {
    std::string text;
    for (const key_value& k : keys) {
        text += (text.empty() ? "" : ", ") + k.key + " = ";
        for (std::size_t i = 0; i < k.values.size(); ++i)
            text += fmt::format("{}{:.5g}", i == 0 ? "" : " ", k.values[i]);
    }
    return text;
}

/// Settings that are one number each; tables are in the JSON.
inline std::vector<key_value> short_of(std::vector<key_value> keys) {
    std::erase_if(keys, [](const key_value& k) { return k.values.size() > 1; });
    return keys;
}

inline const char* length_of(const compensated_axis& a) { return a.kind == axis_kind::rotary ? "rad" : "m"; }

inline std::string sentence(const compensation& c, const compensated_axis& a) {
    const char* const m = length_of(a);
    std::string text =
        c.effects.empty() ? c.name + ": " : fmt::format("{} (against {}): ", c.name, named(c.effects, "and"));
    if (a.forecast && c.claimed)
        text +=
            fmt::format("takes the error from {} to {} rms, {} off; with every fitted value at an end of its "
                        "interval at least {} off.",
                        quantity(a.measured.rms_m.value, m), ranged(c.after.rms_m, m), percent(c.gain.value),
                        percent(c.gain_at_ends));
    else if (a.forecast)
        text += fmt::format("no gain is claimed: {} rms now, {} with it.", quantity(a.measured.rms_m.value, m),
                            ranged(c.after.rms_m, m));
    else
        text += "nothing is forecast without a controller.";
    return text;
}

inline std::string table(const compensated_axis& a) {
    const char* const m = length_of(a);
    const auto row = [](std::string_view name, std::string_view rms, std::string_view peak,
                        std::string_view glitch, std::string_view command) {
        return "  " + padded(std::string(name), 34) + padded(std::string(rms), 24) +
               padded(std::string(peak), 14) + padded(std::string(glitch), 14) + std::string(command) + "\n";
    };
    const auto glitch = [&](const estimate& e) {
        return e.value > 0 ? quantity(e.value, m) : std::string("-");
    };
    std::string text = row("tracking error", "rms", "peak", "reversals", "command, rms");
    text += row("measured", quantity(a.measured.rms_m.value, m), quantity(a.measured.peak_m.value, m),
                glitch(a.measured.glitch_m), quantity(a.measured.command_rms_V.value, a.command_unit));
    for (const compensation& c : a.compensations)
        text += row(c.name, ranged(c.after.rms_m, m), quantity(c.after.peak_m.value, m),
                    glitch(c.after.glitch_m), quantity(c.after.command_rms_V.value, a.command_unit));
    return text;
}

inline std::string summary(const compensation_result& r, bool verbose) {
    std::string text =
        wrapped(fmt::format("What a compensation in the controller would gain on {}", r.log_file), 0) + "\n";
    for (const compensated_axis& a : r.axes) {
        text += wrapped(fmt::format("Axis {}", a.name), 0);
        if (a.forecast && !a.compensations.empty()) text += table(a);
        if (a.forecast && !a.positions_only && !a.compensations.empty())
            text += wrapped(fmt::format("The simulated loop is {} rms beside the logged position before "
                                        "anything is compensated.",
                                        quantity(a.missed_rms_m, length_of(a))),
                            2);
        if (a.compensations.empty()) text += wrapped("No cause of the diagnosis has a feedforward.", 2);
        for (const compensation& c : a.compensations) {
            text += wrapped(sentence(c, a), 2);
            if (!c.keys.empty() && (c.by_keys() || c.of_drive()))
                text += wrapped("in the controller: " + settings(c.keys), 4);
            if (c.of_drive()) text += wrapped("to the drive: " + settings(c.settings), 4);
            if (c.block.empty() && c.keys.empty() && !c.of_drive()) // in a control that takes positions
                text += wrapped("in the control: " + settings(short_of(c.settings)), 4);
            if (!c.settings.empty() && verbose && !c.of_drive())
                text += wrapped(c.block + ": " + settings(c.settings), 4);
        }
        for (const advice& o : a.others)
            text += wrapped(fmt::format("{}: no feedforward. {}.", name_of_effect(o.effect), o.text), 2);
        text += "\n";
    }
    const auto of_positions =
        std::count_if(r.axes.begin(), r.axes.end(), [](const compensated_axis& a) { return a.positions_only; });
    if (std::cmp_less(of_positions, r.axes.size()))
        text += wrapped(
            "The forecast: logged error plus what the compensation changes in the simulated loop, over 16 "
            "plants drawn from the intervals of the diagnosis; the feedforward has the values found.",
            0);
    if (of_positions > 0)
        text +=
            wrapped("The forecast of two positions: their logged difference, less what the control's "
                    "compensation moves the second one by; in brackets with values from the intervals of the "
                    "diagnosis. Tables are in the JSON.",
                    0);
    for (const std::string& note : r.notes) text += wrapped("Note: " + note + ".", 0);
    return text;
}

} // namespace quadrant_gap
