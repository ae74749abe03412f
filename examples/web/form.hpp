// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/init.hpp>
#include <quadrant/diagnosis/machine_file/init_fields.hpp>
#include <quadrant/diagnosis/text/axis_words.hpp>

#include <nlohmann/json.hpp>

/// The questions of `quadrant-gap init` as a form of the page: what the log answers itself stands in the
/// fields.
namespace quadrant_web {
using namespace quadrant::diagnosis;

/// "mass is missing": the options of the command line are fields here.
inline std::string without_options(std::string text) {
    for (std::size_t at; (at = text.find("--")) != text.npos;) text.erase(at, 2);
    if (const auto hint = text.find(" (from-log takes it)"); hint != text.npos) text.erase(hint, 20);
    if (const auto hint = text.find(" (unchecked writes"); hint != text.npos) text.erase(hint);
    return text;
}

/// "velocity-gain" as words.
inline std::string spaced(std::string text) {
    std::replace(text.begin(), text.end(), '-', ' ');
    return text;
}

/// What the form asks, by the axes of a log.
inline nlohmann::json form_fields(const machine_log& log) {
    nlohmann::json out = nlohmann::json::array();
    const axis_kind kind = log.axes.front().kind;
    const bool force = is_force(log.axes.front().command_unit);
    for (const init_field& f : init_fields) {
        if ((f.rotary_only && kind == axis_kind::linear) ||
            (force && f.option == std::string("force-constant")))
            continue;
        const bool usual = f.box == std::string("controller") || f.option == std::string("mass") ||
                           f.option == std::string("force-constant") || f.option == std::string("viscous") ||
                           f.option == std::string("coulomb") || f.option == std::string("delay") ||
                           std::string_view(f.option).starts_with("tolerance-mass") ||
                           std::string_view(f.option).starts_with("tolerance-force");
        out.push_back({{"option", f.option},
                       {"box", f.box},
                       {"name", spaced(text_of(f.option, kind))},
                       {"label", text_of(f.meaning, kind)},
                       {"unit", text_of(f.unit, kind)},
                       {"often", usual}});
    }
    return out;
}

/// The values that a machine file holds, by option and axis: what the page shows in empty fields.
inline nlohmann::json values_in(const nlohmann::ordered_json& machine, const machine_log& log) {
    nlohmann::json out = nlohmann::json::object();
    for (const axis_log& a : log.axes) {
        if (!machine["axes"].contains(a.name)) continue;
        for (const init_field& f : init_fields) {
            std::string key = key_of(f.key, a.kind);
            if (f.key == std::string("force_constant_N_per_V")) key.back() = a.command_unit[0];
            const nlohmann::ordered_json* at = &machine["axes"][a.name];
            const auto step = [&](const std::string& name) {
                at = at && at->is_object() && at->contains(name) ? &(*at)[name] : nullptr;
            };
            step(f.box);
            for (std::size_t dot; (dot = key.find('.')) != key.npos; key.erase(0, dot + 1))
                step(key.substr(0, dot));
            step(key);
            if (at && at->is_number()) out[f.option][a.name] = *at;
        }
    }
    return out;
}

/// A machine file from the fields that are filled, or what is still missing.
inline nlohmann::json begun_machine(const machine_log& log, const nlohmann::json& request) {
    init_request ask;
    ask.from_log = true;
    if (request.value("measured", false)) ask.command_is = command_origin::measured;
    for (const auto& [option, axes] : request.at("values").items())
        for (const auto& [axis, value] : axes.items()) ask.values[option][axis] = value.get<double>();
    nlohmann::json out = {{"ready", false}, {"fields", form_fields(log)}};
    try {
        const auto begun = init_machine(ask, &log);
        out["ready"] = true;
        out["machine"] = begun.machine.dump(2) + "\n";
        out["found"] = values_in(begun.machine, log);
        out["notes"] = begun.notes;
    } catch (const bad_input& fault) {
        out["message"] = without_options(fault.what());
    }
    return out;
}

} // namespace quadrant_web
