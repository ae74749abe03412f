// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "controller/json.hpp"
#include "read/machine_keys.hpp"

namespace quadrant::diagnosis {

namespace detail {

/// The numbers of one box under the keys by which they are read; what is not described gets none.
template <class Target, std::size_t N>
nlohmann::ordered_json numbers_json(const std::array<number_key<Target>, N>& keys, const Target& box) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const auto& key : keys)
        if (const auto value = key.get(box)) out[key.name] = *value;
    return out;
}

inline void put_unless_empty(nlohmann::ordered_json& box, const char* key, const std::vector<double>& values) {
    if (!values.empty()) box[key] = values;
}

inline nlohmann::ordered_json plant_json(const axis_description& a) {
    const plant_description& p = a.plant;
    auto out = numbers_json(plant_keys, p);
    if (!is_force(a.command_unit)) out["force_constant_N_per_" + a.command_unit] = p.force_constant_N_per_V;
    put_unless_empty(out, "cogging_N", p.cogging_N);
    put_unless_empty(out, "cogging_phase_rad", p.cogging_phase_rad);
    put_unless_empty(out, "gms_weights", p.gms_weights);
    put_unless_empty(out, "gms_stiffness_N_per_m", p.gms_stiffness_N_per_m);
    return out;
}

inline nlohmann::ordered_json actuator_json(const actuator_description& a) {
    auto out = numbers_json(actuator_keys, a);
    if (a.dac_bits) out["dac_bits"] = *a.dac_bits;
    return out;
}

inline nlohmann::ordered_json process_json(const process_description& p) {
    auto out = numbers_json(process_keys, p);
    put_unless_empty(out, "force_N", p.force_N);
    put_unless_empty(out, "phase_rad", p.phase_rad);
    return out;
}

/// The boxes of an axis under the keys of its kind.
inline nlohmann::ordered_json in_words_of(axis_kind kind, const nlohmann::ordered_json& boxes) {
    if (kind == axis_kind::linear || !boxes.is_object()) return boxes;
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const auto& [key, value] : boxes.items()) out[key_of(key, kind)] = in_words_of(kind, value);
    return out;
}

inline nlohmann::ordered_json axis_json(const axis_description& a) {
    nlohmann::ordered_json tolerance = nlohmann::ordered_json::object(), out = {{"plant", plant_json(a)}};
    for (const auto& [key, value] : a.tolerance.given)
        if (key != "force_constant" || !is_force(a.command_unit))
            tolerance[key] = value; // there 0 by definition
    const auto box = [&](const char* name, nlohmann::ordered_json content) {
        if (!content.empty()) out[name] = std::move(content);
    };
    box("tolerance", std::move(tolerance));
    box("encoder", numbers_json(encoder_keys, a.encoder));
    box("actuator", actuator_json(a.actuator));
    box("process", process_json(a.process));
    if (a.controller && !a.controller->own) out["controller"] = controller_json(*a.controller);
    return in_words_of(a.kind, out);
}

} // namespace detail

/// The machine file (FORMAT.md) of a description: read_machine() of it gives the description back, but for a controller
/// of unknown kind, of which a description holds nothing, and for what is code: controllers, effects and forces of your own.
inline nlohmann::ordered_json to_json(const machine_description& m) {
    nlohmann::ordered_json out = {{"schema", "quadrant.machine/1"}, {"sample_period_s", m.sample_period_s}};
    if (!m.excluded_effects.empty()) out["excluded_effects"] = m.excluded_effects;
    auto& axes = out["axes"] = nlohmann::ordered_json::object();
    for (const axis_description& a : m.axes) axes[a.name] = detail::axis_json(a);
    return out;
}

} // namespace quadrant::diagnosis
