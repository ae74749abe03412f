// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "controller/json.hpp"
#include "machine_file/machine_keys.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// The numbers of one box under the keys by which they are read; what is not described gets none.
template <class Target, std::size_t N>
nlohmann::ordered_json numbers_json(const std::array<number_key<Target>, N>& keys, const Target& box) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const auto& key : keys)
        if (const auto value = key.get(box)) out[key.name] = *value;
    return out;
}

/// What a description says of effects in one box, under the keys of a linear axis.
inline nlohmann::ordered_json effects_json(std::string_view box, const axis_description& a) {
    auto out = nlohmann::ordered_json::object();
    for_each_key(box, [&](const machine_key& k, const effect& e) {
        std::string key(k.key());
        if (k.unit_of_command && is_force(a.command_unit)) return;
        if (k.unit_of_command) key.back() = a.command_unit[0];
        const auto values = numbers_of(a, k, e);
        if (values.empty()) return;
        if (k.shape == key_shape::number)
            out[key] = values[0];
        else
            out[key] = values;
    });
    return out;
}

/// What a drive is, beside the numbers that effects have.
inline nlohmann::ordered_json drive_json(const drive_description& d) {
    auto out = numbers_json(drive_number_keys, d);
    out["kind"] = name_of(d.kind);
    if (d.between) out["interpolation"] = name_of(*d.between);
    return out;
}

QUADRANT_DIAGNOSIS_DECL nlohmann::ordered_json in_words_of(axis_kind kind, std::string_view box,
                                                           const nlohmann::ordered_json& content) {
    if (kind == axis_kind::linear || !content.is_object()) return content;
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const auto& [key, value] : content.items()) {
        const machine_key* known = key_named(box == "plant" ? key : fmt::format("{}.{}", box, key));
        out[known ? known->key_for(kind) : key_of(key, kind)] = in_words_of(kind, "", value);
    }
    return out;
}

inline nlohmann::ordered_json axis_json(const axis_description& a) {
    nlohmann::ordered_json tolerance = nlohmann::ordered_json::object(), out;
    const auto box = [&](std::string_view name, const nlohmann::ordered_json& content) {
        if (!content.empty()) out[std::string(name)] = in_words_of(a.kind, name, content);
    };
    for (const std::string_view name : boxes_of_effects()) {
        if (name == "plant" && a.positions_only) continue;
        auto content = effects_json(name, a);
        if (name == "actuator") content.update(numbers_json(actuator_keys, a.actuator));
        if (name == "actuator" && a.actuator.dac_bits) content["dac_bits"] = *a.actuator.dac_bits;
        if (name == "actuator" && a.actuator.command_is != command_origin::asked)
            content["command_is"] = name_of(a.actuator.command_is);
        if (name == "drive" && a.drive.closes()) content.update(drive_json(a.drive));
        if (name == "transmission") {
            content.update(numbers_json(transmission_number_keys, a.transmission));
            if (a.transmission.kind) content["kind"] = name_of(*a.transmission.kind);
        }
        box(name, content);
    }
    for (const auto& [key, value] : a.tolerance.given)
        if (key != "force_constant" || !is_force(a.command_unit))
            tolerance[key] = value; // there 0 by definition
    box("tolerance", tolerance);
    if (a.motor_encoder.resolution_rad)
        out["motor_encoder"]["resolution_rad"] = *a.motor_encoder.resolution_rad;
    if (a.motor_encoder.resolution_m) out["motor_encoder"]["resolution_m"] = *a.motor_encoder.resolution_m;
    if (a.gantry_pair)
        out["gantry_pair"] = {{"ends", {a.gantry_pair->first, a.gantry_pair->second}},
                              {"share", a.gantry_pair->share}};
    if (a.controller && !a.controller->own) box("controller", controller_json(*a.controller));
    return out;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL nlohmann::ordered_json to_json(const machine_description& m) {
    nlohmann::ordered_json out = {{"schema", "quadrant.machine/1"}, {"sample_period_s", m.sample_period_s}};
    if (!m.excluded_effects.empty()) out["excluded_effects"] = m.excluded_effects;
    auto& axes = out["axes"] = nlohmann::ordered_json::object();
    for (const axis_description& a : m.axes) axes[a.name] = detail::axis_json(a);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
