// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect/actuator_dead_zone.hpp"
#include "effect/actuator_lag.hpp"
#include "effect/actuator_saturation.hpp"
#include "effect/added_command.hpp"
#include "effect/arm_length.hpp"
#include "effect/asymmetric_friction.hpp"
#include "effect/backlash.hpp"
#include "effect/clock_slip.hpp"
#include "effect/cogging.hpp"
#include "effect/command_delay.hpp"
#include "effect/constant_force.hpp"
#include "effect/controller_mismatch.hpp"
#include "effect/coulomb_friction.hpp"
#include "effect/cross_coupling.hpp"
#include "effect/cutting_force.hpp"
#include "effect/drive_dropout.hpp"
#include "effect/drive_gain.hpp"
#include "effect/drive_limit.hpp"
#include "effect/encoder_cyclic_error.hpp"
#include "effect/encoder_quantization.hpp"
#include "effect/force_constant.hpp"
#include "effect/force_ripple.hpp"
#include "effect/friction_drift.hpp"
#include "effect/gravity.hpp"
#include "effect/load_friction.hpp"
#include "effect/mass.hpp"
#include "effect/minimum_duty.hpp"
#include "effect/payload_mass.hpp"
#include "effect/position_dependent_friction.hpp"
#include "effect/position_spring.hpp"
#include "effect/presliding_friction.hpp"
#include "effect/quadratic_drag.hpp"
#include "effect/sample_loss.hpp"
#include "effect/set_point_loss.hpp"
#include "effect/setpoint_rate_limit.hpp"
#include "effect/stribeck_friction.hpp"
#include "effect/structural_resonance.hpp"
#include "effect/supply_voltage.hpp"
#include "effect/time_delay.hpp"
#include "effect/unlisted.hpp"
#include "effect/viscous_friction.hpp"

namespace quadrant::diagnosis {

// clang-format off
/// The list: one include above and one line here for each effect, in the order in which files and pages name
/// them.
inline constexpr std::array listed_effects{
    &suspect::coulomb_friction,
    &suspect::viscous_friction,
    &suspect::stribeck_friction,
    &suspect::presliding_friction,
    &suspect::asymmetric_friction,
    &suspect::position_dependent_friction,
    &suspect::friction_drift,
    &suspect::load_friction,
    &suspect::mass,
    &suspect::structural_resonance,
    &suspect::backlash,
    &suspect::constant_force,
    &suspect::position_spring,
    &suspect::gravity,
    &suspect::payload_mass,
    &suspect::arm_length,
    &suspect::quadratic_drag,
    &suspect::cross_coupling,
    &suspect::cogging,
    &suspect::force_ripple,
    &suspect::force_constant,
    &suspect::time_delay,
    &suspect::actuator_lag,
    &suspect::actuator_saturation,
    &suspect::actuator_dead_zone,
    &suspect::sample_loss,
    &suspect::drive_gain,
    &suspect::drive_limit,
    &suspect::supply_voltage,
    &suspect::minimum_duty,
    &suspect::command_delay,
    &suspect::setpoint_rate_limit,
    &suspect::set_point_loss,
    &suspect::clock_slip,
    &suspect::drive_dropout,
    &suspect::encoder_quantization,
    &suspect::encoder_cyclic_error,
    &suspect::cutting_force,
    &suspect::controller_mismatch,
    &suspect::added_command,
};
// clang-format on

/// Those of them that are found by a fit of the plant, in the same order. The controller is judged apart, by
/// replay, and the encoder's count by what the positions are multiples of.
inline constexpr auto plant_effects = [] {
    constexpr auto fitted = [](const effect* e) { return e->starts != nullptr; };
    std::array<const effect*,
               static_cast<std::size_t>(std::count_if(listed_effects.begin(), listed_effects.end(), fitted))>
        out{};
    std::copy_if(listed_effects.begin(), listed_effects.end(), out.begin(), fitted);
    return out;
}();

} // namespace quadrant::diagnosis
