// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The load stands still after a reversal until the motor has crossed the play.
/// Found by the difference of two readings (chain/search.hpp), not by a fit of the plant.
inline constexpr effect lost_motion{
    .name = "lost_motion",
    .label = "lost motion",
    .box = "transmission",
    .joins = joint::transmission,
    .exciting_motion = "slow reversals all along the travel",
    .shows = "the scale stands still after each reversal while the motor goes on",
    .keys = {machine_key{.name = "transmission.backlash_m",
                         .rule = detail::rule::not_negative,
                         .meaning = "play between motor and load",
                         .at = member<&transmission_description::backlash_m>,
                         .tolerance = true}},
    .prior = {0.8,
              "nuts, gears and belts have play, and without a force wind-up under friction looks the same"},
    .remedy = "Preload the nut or the gear; or let the control add the lost motion at each reversal.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "preload the nut or the gear, or let the control add the lost motion at each reversal";
    },
};

} // namespace quadrant::inline v0::diagnosis::suspect
