// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The transmission is softer (or stiffer) than described: the load stays behind by force over stiffness.
/// Found by the difference of two readings (chain/search.hpp), not by a fit of the plant.
inline constexpr effect wind_up{
    .name = "wind_up",
    .label = "wind-up",
    .box = "transmission",
    .joins = joint::transmission,
    .exciting_motion = "strong accelerations, several times",
    .shows = "a difference of the two readings that follows the force through the transmission",
    .keys = {machine_key{.name = "transmission.stiffness_N_per_m",
                         .rule = detail::rule::positive,
                         .meaning = "of screw, belt or gear between motor and load; absent: rigid",
                         .at = member<&transmission_description::stiffness_N_per_m>,
                         .tolerance = true}},
    .prior = {0.8, "nothing that carries a force is rigid"},
    .remedy = "Close the position loop on the scale, or feed the wind-up forward by force over stiffness.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "close the position loop on the scale, or feed the wind-up forward by force over stiffness";
    },
};

} // namespace quadrant::inline v0::diagnosis::suspect
