// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// One number that begins a machine file: the option that asks for it, where it goes, and between what sizes it
/// usually is. Key, unit and meaning are those of a linear axis (axis_words.hpp); so are the sizes, where the
/// unit is.
struct init_field {
    const char* option;
    const char* box;
    const char* key;
    const char* unit; ///< SI; "" for a pure number
    const char* meaning;
    double low, high;
    bool whole = false;
    bool rotary_only = false;
};

inline constexpr std::array init_fields{
    init_field{"mass", "plant", "mass_kg", "kg", "moving mass, all that the motor accelerates", 1e-3, 1e5},
    init_field{"force-constant", "plant", "force_constant_N_per_V", "N per unit of the command",
               "force for one unit of the command", 1e-3, 1e6},
    init_field{"viscous", "plant", "viscous_N_s_per_m", "N s/m", "viscous friction", 1e-3, 1e6},
    init_field{"delay", "plant", "delay_s", "s",
               "from the sample instant to the command's first action, without the hold", 1e-6, 0.02},
    init_field{"coulomb", "plant", "coulomb_N", "N", "Coulomb friction", 1e-3, 1e5},
    init_field{"static", "plant", "static_N", "N", "static friction, not below the Coulomb level", 1e-3, 1e5},
    init_field{"stribeck-velocity", "plant", "stribeck_velocity_m_per_s", "m/s",
               "speed at which static friction has faded", 1e-5, 0.2},
    init_field{"gravity-torque", "plant", "gravity_torque_Nm", "Nm",
               "largest torque of the weight that the axis turns", 1e-4, 1e5, false, true},
    init_field{"gravity-phase", "plant", "gravity_phase_rad", "rad", "position at which that weight hangs down",
               1e-6, 6.3, false, true},
    init_field{"constant-force", "plant", "constant_force_N", "N",
               "force that acts all the time: gravity, an amplifier's offset", 1e-3, 1e5},
    init_field{"load-friction", "plant", "load_friction", "",
               "growth of the Coulomb friction with the transmitted force", 1e-3, 1},
    init_field{"tolerance-mass", "tolerance", "mass", "", "how well the mass is known, relative", 1e-3, 0.3},
    init_field{"tolerance-force-constant", "tolerance", "force_constant", "",
               "how well the force constant is known, relative", 1e-3, 0.3},
    init_field{"tolerance-viscous", "tolerance", "viscous", "",
               "how well the viscous friction is known, relative", 1e-3, 0.5},
    init_field{"tolerance-coulomb", "tolerance", "coulomb", "",
               "how well the Coulomb friction is known, relative", 1e-3, 0.5},
    init_field{"resolution", "encoder", "resolution_m", "m", "step of the position reading", 1e-10, 1e-3},
    init_field{"limit", "actuator", "limit_V", "units of the command", "the controller's own limit", 0.1, 1e4},
    init_field{"dac-bits", "actuator", "dac_bits", "bits", "resolution of the DAC", 8, 24, true},
    init_field{"dac-range", "actuator", "dac_range_V", "units of the command",
               "whole range of the DAC: 20 for +-10 V", 1, 1e4},
    init_field{"position-gain", "controller", "position_gain_per_s", "1/s", "gain of the position loop", 1,
               1e3},
    init_field{"velocity-gain", "controller", "velocity_gain_V_s_per_m", "units of the command per m/s",
               "gain of the velocity loop", 1e-2, 1e5},
    init_field{"velocity-integral", "controller", "velocity_integral_V_per_m", "units of the command per m",
               "integral gain of the velocity loop", 1e-2, 1e7},
    init_field{"velocity-filter", "controller", "velocity_filter_Hz", "Hz", "corner of the filtered derivative",
               1, 5e3},
    init_field{"velocity-feedforward", "controller", "velocity_feedforward", "",
               "1: the reference's speed in full", 0.01, 2},
    init_field{"acceleration-feedforward", "controller", "acceleration_feedforward_V_s2_per_m",
               "units of the command per m/s^2", "feedforward of the acceleration", 1e-6, 1e3},
    init_field{"viscous-feedforward", "controller", "viscous_feedforward_V_s_per_m",
               "units of the command per m/s", "feedforward of viscous friction", 1e-6, 1e4},
    init_field{"coulomb-feedforward", "controller", "coulomb_feedforward_V", "units of the command",
               "feedforward of Coulomb friction", 1e-6, 1e3},
    init_field{"notch-frequency", "controller", "notch.frequency_Hz", "Hz", "notch behind the velocity loop", 1,
               5e3},
    init_field{"notch-width", "controller", "notch.width", "", "relative width between its -3 dB points", 1e-3,
               2},
};

/// The numbers of a drive with loops of its own (drive_keys.hpp says which kind has which).
inline constexpr std::array drive_init_fields{
    init_field{"velocity-per-volt", "drive", "velocity_per_V", "m/s per V", "velocity that one volt asks for",
               1e-5, 10},
    init_field{"drive-position-gain", "drive", "position_gain_per_s", "1/s", "P of the drive's position loop",
               0.1, 1e3},
    init_field{"drive-velocity-gain", "drive", "velocity_gain_N_s_per_m", "N s/m",
               "P of the drive's velocity loop", 1e-4, 1e7},
    init_field{"drive-velocity-integral", "drive", "velocity_integral_N_per_m", "N/m",
               "I of the drive's velocity loop", 1e-4, 1e10},
    init_field{"drive-velocity-filter", "drive", "velocity_filter_Hz", "Hz", "filter of the drive's velocity",
               1, 1e4},
    init_field{"drive-velocity-feedforward", "drive", "velocity_feedforward", "",
               "share of the set-points' velocity that the drive adds", 0.01, 2},
    init_field{"force-limit", "drive", "force_limit_N", "N", "largest force of the drive", 1e-3, 1e6},
    init_field{"command-delay", "drive", "command_delay_s", "s",
               "from the row to the drive's use of its command", 1e-6, 1},
    init_field{"set-point-period", "drive", "set_point_period_s", "s", "between two set-points", 1e-5, 1},
    init_field{"servo-gain", "drive", "position_gain_per_m", "duty per m", "P of a position servo", 1e-3, 1e4},
    init_field{"minimum-duty", "drive", "minimum_duty", "", "duty added in the direction of the error", 1e-4,
               0.5},
    init_field{"maximum-duty", "drive", "maximum_duty", "", "largest duty", 0.05, 1},
    init_field{"setpoint-rate-limit", "drive", "setpoint_rate_limit_m_per_s", "m/s",
               "speed at which a servo follows a set-point at most", 1e-4, 1e3},
    init_field{"supply", "drive", "supply_V", "V", "supply of a position servo", 1, 1e3},
};

} // namespace quadrant::inline v0::diagnosis
