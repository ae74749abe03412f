// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "what_if.hpp"

#include "quadrant_gap/compensation_summary.hpp"

#include <quadrant/diagnosis/compensate.hpp>
#include <quadrant/diagnosis/write_compensation.hpp>

/// What a compensation in the controller would gain on the machine as the sliders set it.
namespace quadrant_web {

/// A row of the table: a name, then error rms, peak and at reversals, and the command.
inline nlohmann::json tracking_row(const std::string& name, const std::string& rms, const tracking& t,
                                   const std::string& command_unit) {
    const auto text = [](const estimate& e, const std::string& unit) {
        return quadrant_gap::quantity(e.value, unit);
    };
    return {name, rms, text(t.peak_m, "m"), t.glitch_m.value > 0 ? text(t.glitch_m, "m") : "-",
            text(t.command_rms_V, command_unit)};
}

/// The tracking error of the simulated loop, reference minus position, on a log whose columns are in time.
inline nlohmann::json tracking_curve(const machine_description& machine, const machine_log& log,
                                     const std::string& axis) {
    const simulation_result run = simulate(machine, log, log_columns::as_they_stand, force_places::left_out);
    const simulated_axis& simulated = *detail::named(run.axes, axis);
    const axis_log& logged = *detail::named(log.axes, axis);
    std::vector<double> error(simulated.position.size());
    std::transform(simulated.position.begin(), simulated.position.end(), logged.reference.begin(),
                   error.begin(), [](double position, double reference) { return reference - position; });
    constexpr std::size_t buckets = 700;
    return {{"lines", envelope(error, buckets)}, {"seconds", simulated.t.empty() ? 0 : simulated.t.back()}};
}

/// The forecasts as the page shows them, and the controller's keys that gain. `corrected` is the text of the
/// machine file with the causes in it.
inline nlohmann::json drawn(const compensation_result& r, const nlohmann::ordered_json& corrected,
                            const machine_log& log) {
    const auto patch = controller_patch(r);
    auto patched = corrected;
    patched.merge_patch(patch);
    const machine_description bare = read_machine(corrected.dump(), r.machine_file),
                              with_keys = read_machine(patched.dump(), r.machine_file);
    nlohmann::json axes = nlohmann::json::array();
    for (const compensated_axis& a : r.axes) {
        nlohmann::json rows = nlohmann::json::array(), says = nlohmann::json::array();
        if (a.forecast && !a.compensations.empty())
            rows.push_back(tracking_row("measured", quadrant_gap::quantity(a.measured.rms_m.value, "m"),
                                        a.measured, a.command_unit));
        for (const compensation& c : a.compensations) {
            if (a.forecast)
                rows.push_back(
                    tracking_row(c.name, quadrant_gap::ranged(c.after.rms_m, "m"), c.after, a.command_unit));
            std::string text = quadrant_gap::sentence(c, a);
            if (!c.keys.empty() && c.by_keys())
                text += " In the controller: " + quadrant_gap::settings(c.keys) + ".";
            else if (c.of_drive())
                text += " To the drive: " + quadrant_gap::settings(c.settings) + ".";
            else if (!c.settings.empty())
                text += " Block " + c.block + ": " + quadrant_gap::settings(c.settings) + ".";
            says.push_back(text);
        }
        for (const advice& o : a.others)
            says.push_back(
                fmt::format("{}: no feedforward. {}.", quadrant_gap::name_of_effect(o.effect), o.text));
        if (a.compensations.empty() && a.others.empty())
            says.push_back("No cause that is switched on has a feedforward.");
        nlohmann::json out = {{"axis", a.name}, {"rows", rows}, {"says", says}};
        if (patch.contains("axes") && patch["axes"].contains(a.name)) {
            out["before"] = tracking_curve(bare, log, a.name);
            out["after"] = tracking_curve(with_keys, log, a.name);
        }
        axes.push_back(out);
    }
    nlohmann::json out = {
        {"axes", axes},
        {"notes", r.notes},
        {"forecast", to_json(r).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"}};
    if (!patch.empty()) out["machine_text"] = patched.dump(2) + "\n";
    return out;
}

} // namespace quadrant_web
