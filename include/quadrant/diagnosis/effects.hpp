// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect/asymmetric_friction.hpp"
#include "effect/cogging.hpp"
#include "effect/constant_force.hpp"
#include "effect/coulomb_friction.hpp"
#include "effect/force_constant.hpp"
#include "effect/mass.hpp"
#include "effect/stribeck_friction.hpp"
#include "effect/time_delay.hpp"
#include "effect/viscous_friction.hpp"

namespace quadrant::diagnosis {

/// Every suspect behind the command wire. The controller is judged apart, by replay.
inline constexpr std::array plant_effects{&suspect::coulomb_friction,
                                          &suspect::viscous_friction,
                                          &suspect::stribeck_friction,
                                          &suspect::asymmetric_friction,
                                          &suspect::mass,
                                          &suspect::force_constant,
                                          &suspect::time_delay,
                                          &suspect::constant_force,
                                          &suspect::cogging};

} // namespace quadrant::diagnosis
