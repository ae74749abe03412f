// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The load goes further (or less far) at each turn than described.
/// Found by the difference of two readings (chain/search.hpp), not by a fit of the plant.
inline constexpr effect scale_error{
    .name = "scale_error",
    .label = "scale error",
    .box = "transmission",
    .joins = joint::transmission,
    .exciting_motion = "slow strokes over the whole travel",
    .shows = "a difference of the two readings that is proportional to the travel",
    .keys = {machine_key{.name = "transmission.travel_per_turn_m",
                         .rule = detail::rule::positive,
                         .meaning = "travel of the load at one turn of the motor",
                         .at = member<&transmission_description::travel_per_turn_m>},
             machine_key{.name = "transmission.counted_per_turn_m",
                         .rule = detail::rule::positive,
                         .meaning =
                             "with which asked or counted positions were made; absent: travel_per_turn_m",
                         .at = member<&transmission_description::counted_per_turn_m>}},
    .prior = {0.8, "leads and pulleys have tolerances, and screws grow when they are warm"},
    .remedy =
        "Set the counts a millimetre of the control by the ratio found; look again when the machine is warm.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "set the counts a millimetre of the control by the ratio found";
    },
};

} // namespace quadrant::inline v0::diagnosis::suspect
