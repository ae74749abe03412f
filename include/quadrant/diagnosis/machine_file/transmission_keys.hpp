// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "drive_keys.hpp"

/// What a machine file says of a transmission and of the motor's encoder beside the keys of effects.
namespace quadrant::inline v0::diagnosis::detail {

inline constexpr std::array transmission_number_keys{
    number_key<transmission_description>{"damping_N_s_per_m", rule::not_negative,
                                         &transmission_description::damping_N_s_per_m},
    number_key<transmission_description>{"motor_mass_kg", rule::positive,
                                         &transmission_description::motor_mass_kg},
};
inline constexpr std::array<std::string_view, 3> transmission_other_keys{"kind", "damping_N_s_per_m",
                                                                         "motor_mass_kg"};
inline constexpr std::array<std::string_view, 2> motor_encoder_keys{"resolution_rad", "resolution_m"};

/// The keys that belong to no effect.
inline void read_transmission_others(const json_node& node, transmission_description& out) {
    if (const auto kind = node.find("kind"))
        out.kind = static_cast<transmission_kind>(word_of(*kind, transmission_kinds));
    for (const auto& key : transmission_number_keys)
        if (const auto given = node.find(key.name)) key.set(out, given->number(key.rule));
}

/// The encoder on the motor: in radians of its turn, or in units of the load (on a linear axis).
inline void read_motor_encoder(const json_node& node, motor_encoder_description& out) {
    for (const auto& [key, value] : node.object().value->items()) {
        const json_node given = node.at(key, value);
        if (key == "resolution_rad")
            out.resolution_rad = given.number(rule::positive);
        else if (key == "resolution_m" && node.kind == axis_kind::linear)
            out.resolution_m = given.number(rule::positive);
        else
            given.refuse("unknown key" + suggestion(key, motor_encoder_keys));
    }
}

} // namespace quadrant::inline v0::diagnosis::detail
