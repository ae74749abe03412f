// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "actuator_dead_zone.hpp"
#include "actuator_lag.hpp"
#include "actuator_saturation.hpp"
#include "added_command.hpp"
#include "arm_length.hpp"
#include "asymmetric_friction.hpp"
#include "backlash.hpp"
#include "clock_slip.hpp"
#include "cogging.hpp"
#include "command_delay.hpp"
#include "constant_force.hpp"
#include "controller_mismatch.hpp"
#include "coulomb_friction.hpp"
#include "cross_coupling.hpp"
#include "cutting_force.hpp"
#include "drive_dropout.hpp"
#include "drive_gain.hpp"
#include "drive_limit.hpp"
#include "encoder_cyclic_error.hpp"
#include "encoder_quantization.hpp"
#include "force_constant.hpp"
#include "force_ripple.hpp"
#include "friction_drift.hpp"
#include "gravity.hpp"
#include "load_friction.hpp"
#include "lost_motion.hpp"
#include "mass.hpp"
#include "minimum_duty.hpp"
#include "missed_steps.hpp"
#include "motor_friction.hpp"
#include "payload_mass.hpp"
#include "pitch_error.hpp"
#include "position_dependent_friction.hpp"
#include "position_spring.hpp"
#include "presliding_friction.hpp"
#include "quadratic_drag.hpp"
#include "sample_loss.hpp"
#include "scale_error.hpp"
#include "set_point_loss.hpp"
#include "setpoint_rate_limit.hpp"
#include "stribeck_friction.hpp"
#include "structural_resonance.hpp"
#include "supply_voltage.hpp"
#include "time_delay.hpp"
#include "travel_error.hpp"
#include "unlisted.hpp"
#include "viscous_friction.hpp"
#include "wind_up.hpp"

namespace quadrant::inline v0::diagnosis {

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
    &suspect::missed_steps,
    &suspect::lost_motion,
    &suspect::wind_up,
    &suspect::pitch_error,
    &suspect::travel_error,
    &suspect::scale_error,
    &suspect::motor_friction,
    &suspect::clock_slip,
    &suspect::drive_dropout,
    &suspect::encoder_quantization,
    &suspect::encoder_cyclic_error,
    &suspect::cutting_force,
    &suspect::controller_mismatch,
    &suspect::added_command,
};
// clang-format on

} // namespace quadrant::inline v0::diagnosis
