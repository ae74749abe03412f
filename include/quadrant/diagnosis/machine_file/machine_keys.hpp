// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_keys.hpp"
#include "effect_keys.hpp"
#include "gantry_keys.hpp"
#include "transmission_keys.hpp"

/// The keys of a machine file that belong to no effect; those of effects follow from their records
/// (effect_keys.hpp).
namespace quadrant::inline v0::diagnosis::detail {

/// Keys of the actuator that belong to no effect: what the controller itself does to its command, and where the
/// log's command was taken.
inline constexpr std::array actuator_keys{
    number_key<actuator_description>{"limit_V", rule::positive, &actuator_description::limit_V},
    number_key<actuator_description>{"dac_range_V", rule::positive, &actuator_description::dac_range_V},
};
inline constexpr std::array<std::string_view, 4> actuator_other_keys{"limit_V", "dac_range_V", "dac_bits",
                                                                     "command_is"};

/// Boxes of an axis beside those that hold keys of effects.
inline constexpr std::array<std::string_view, 4> axis_other_keys{"tolerance", "controller", "motor_encoder",
                                                                 "gantry_pair"};
inline constexpr std::array<std::string_view, 4> machine_file_keys{"schema", "sample_period_s",
                                                                   "excluded_effects", "axes"};

/// The keys of one box of an axis, by their names on an axis of this kind; `all` as in effect_keys().
inline std::vector<std::string> keys_of_box(std::string_view box, axis_kind kind, bool all = false) {
    std::vector<std::string> out = effect_keys(box, kind, all);
    const auto add = [&](const auto& names) {
        for (const std::string_view name : names) out.push_back(key_of(name, kind));
    };
    if (box == "actuator") add(actuator_other_keys);
    if (box == "drive") add(drive_other_keys);
    if (box == "transmission") add(transmission_other_keys);
    if (box == "tolerance")
        for (const tolerance_name& t : tolerance_names(all ? axis_kind::rotary : kind))
            out.push_back(key_of(t.name, kind));
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
