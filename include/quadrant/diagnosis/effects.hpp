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
inline constexpr std::array plant_effects{&coulomb_friction,
                                          &viscous_friction,
                                          &stribeck_friction,
                                          &asymmetric_friction,
                                          &mass,
                                          &force_constant,
                                          &time_delay,
                                          &constant_force,
                                          &cogging};

} // namespace quadrant::diagnosis
