// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Friction before the transmission, not in the guide: that part of the motor's force winds nothing up.
/// Found by the difference of two readings (chain/search.hpp), not by a fit of the plant.
inline constexpr effect motor_friction{
    .name = "motor_friction",
    .label = "friction on the motor",
    .box = "transmission",
    .joins = joint::transmission,
    .exciting_motion = "strong accelerations and slow strokes, in both directions",
    .shows = "a wind-up that is smaller than the force of the motor by the same in each direction",
    .keys = {machine_key{.name = "transmission.motor_coulomb_N",
                         .rule = detail::rule::not_negative,
                         .meaning = "Coulomb friction on the motor's side, in units of the load",
                         .at = member<&transmission_description::motor_coulomb_N>,
                         .tolerance = true}},
    .prior = {0.4, "bearings and seals of the motor; most friction is in the guide"},
    .remedy = "Look at the bearings and the brake of the motor before those of the guide.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "friction on the motor: look at its bearings and its brake";
    },
};

} // namespace quadrant::inline v0::diagnosis::suspect
