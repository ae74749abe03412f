// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <quadrant/diagnosis/machine_file/machine_keys.hpp>

/// The keys of a machine's file. A new one is a line here and in docs/schema/cnc.schema.json.
namespace quadrant_cnc {

namespace qd = quadrant::diagnosis::detail;

inline constexpr qd::number_rule positive = qd::rule::positive, not_negative = qd::rule::not_negative,
                                 any_number = qd::rule::any_number;
inline constexpr qd::number_rule whole_number{
    "must be a whole number from 0 to 1e6", [](double x) { return x >= 0 && x <= 1e6 && x == std::floor(x); }};
inline constexpr qd::number_rule small{"must be a number between -0.1 and 0.1 (relative)",
                                       [](double x) { return x > -0.1 && x < 0.1; }};

template <class T> using key = qd::number_key<T>;
using names_1 = std::array<std::string_view, 1>;

inline constexpr std::array limit_keys{
    key<limits_description>{"velocity_m_per_s", positive, &limits_description::velocity_m_per_s},
    key<limits_description>{"acceleration_m_per_s2", positive, &limits_description::acceleration_m_per_s2},
    key<limits_description>{"jerk_m_per_s3", positive, &limits_description::jerk_m_per_s3},
};

inline constexpr std::array trajectory_keys{
    key<trajectory_description>{"corner_tolerance_m", not_negative,
                                &trajectory_description::corner_tolerance_m},
};
inline constexpr std::array<std::string_view, 6> trajectory_other_keys{
    "profile", "velocity_m_per_s", "acceleration_m_per_s2", "jerk_m_per_s3", "start_m", "reach_the_feed"};

using screw = ball_screw_description;
inline constexpr std::array ball_screw_keys{
    key<screw>{"amplifier_A_per_V", positive, &screw::amplifier_A_per_V, true},
    key<screw>{"torque_constant_Nm_per_A", positive, &screw::torque_constant_Nm_per_A, true},
    key<screw>{"inertia_kg_m2", positive, &screw::inertia_kg_m2, true},
    key<screw>{"viscous_Nm_s_per_rad", not_negative, &screw::viscous_Nm_s_per_rad},
    key<screw>{"pitch_m", positive, &screw::pitch_m, true},
    key<screw>{"current_limit_A", positive, &screw::current_limit_A},
    key<screw>{"lead_error", small, &screw::lead_error},
    key<screw>{"table_mass_kg", not_negative, &screw::table_mass_kg},
    key<screw>{"compliance_m_per_N", not_negative, &screw::compliance_m_per_N},
    key<screw>{"backlash_m", not_negative, &screw::backlash_m},
};
inline constexpr std::array<std::string_view, 2> ball_screw_other_keys{"kind", "friction"};
inline constexpr std::array<std::string_view, 2> directions{"forward", "backward"};
inline constexpr names_1 kind_key{"kind"};

inline constexpr std::array friction_keys{
    key<friction_side>{"static_Nm", not_negative, &friction_side::static_Nm, true},
    key<friction_side>{"coulomb_Nm", not_negative, &friction_side::coulomb_Nm, true},
    key<friction_side>{"fall_rad_per_s", positive, &friction_side::fall_rad_per_s, true},
    key<friction_side>{"rise_rad_per_s", positive, &friction_side::rise_rad_per_s, true},
};

using linear = linear_motor_description;
inline constexpr std::array linear_motor_keys{
    key<linear>{"mass_kg", positive, &linear::mass_kg, true},
    key<linear>{"force_constant_N_per_V", positive, &linear::force_constant_N_per_V, true},
    key<linear>{"viscous_N_s_per_m", not_negative, &linear::viscous_N_s_per_m},
    key<linear>{"delay_s", qd::rule::up_to_a_second, &linear::delay_s},
    key<linear>{"coulomb_N", not_negative, &linear::coulomb_N},
    key<linear>{"static_N", not_negative, &linear::static_N},
    key<linear>{"stribeck_velocity_m_per_s", positive, &linear::stribeck_velocity_m_per_s},
    key<linear>{"drive_limit_V", positive, &linear::drive_limit_V},
    key<linear>{"amplifier_A_per_V", positive, &linear::amplifier_A_per_V},
};

inline constexpr std::array encoder_keys{
    key<sensor_description>{"resolution_m", not_negative, &sensor_description::resolution_m},
    key<sensor_description>{"noise_m", not_negative, &sensor_description::noise_m},
};
inline constexpr names_1 encoder_other_keys{"on"};
inline constexpr names_1 command_other_keys{"dac_bits"};
inline constexpr std::array tachometer_keys{
    key<sensor_description>{"noise_m_per_s", not_negative, &sensor_description::tachometer_noise_m_per_s},
};
inline constexpr std::array accelerometer_keys{
    key<sensor_description>{"noise_m_per_s2", not_negative, &sensor_description::accelerometer_noise_m_per_s2},
};
using again = acceleration_feedback_description;
inline constexpr std::array acceleration_feedback_keys{
    key<again>{"gain_V_s2_per_m", not_negative, &again::gain_V_s2_per_m, true},
    key<again>{"filter_Hz", positive, &again::filter_Hz, true},
};
using cut = cutting_load_description;
inline constexpr std::array cutting_load_keys{
    key<cut>{"spindle_Hz", positive, &cut::spindle_Hz, true},
    key<cut>{"entry_s", not_negative, &cut::entry_s},
};
inline constexpr std::array<std::string_view, 6> cutting_load_other_keys{"mean_N",  "cosine_N",  "sine_N",
                                                                         "mean_Nm", "cosine_Nm", "sine_Nm"};
inline constexpr std::array command_keys{
    key<command_description>{"limit_V", positive, &command_description::limit_V, true},
    key<command_description>{"dac_range_V", positive, &command_description::dac_range_V},
};
using forward = friction_feedforward_description;
inline constexpr std::array friction_feedforward_keys{
    key<forward>{"scale", not_negative, &forward::scale},
    key<forward>{"width_m_per_s", positive, &forward::width_m_per_s},
};

inline constexpr std::array<std::string_view, 5> cnc_file_keys{"schema", "servo_period_s", "seed", "trajectory",
                                                               "axes"};
inline constexpr std::array<std::string_view, 11> axis_keys{"travel_m",
                                                            "limits",
                                                            "drive",
                                                            "encoder",
                                                            "tachometer",
                                                            "accelerometer",
                                                            "command",
                                                            "control",
                                                            "friction_feedforward",
                                                            "acceleration_feedback",
                                                            "cutting_load"};

} // namespace quadrant_cnc
