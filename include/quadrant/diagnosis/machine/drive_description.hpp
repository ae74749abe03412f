// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../drive/set_point_line.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// What a drive takes: a current, force or torque (every servo amplifier in torque mode), a velocity (+-10 V,
/// or in units of the axis), a position (cyclic synchronous position), or a position that a proportional law
/// turns into the duty of a bridge.
enum class drive_kind { current, velocity, position, position_servo };
inline constexpr std::array<std::string_view, 4> drive_kinds{"current", "velocity", "position",
                                                             "position_servo"};
inline constexpr std::array<std::string_view, 3> interpolations{"hold", "linear", "cubic"};

/// The word of a machine file for it.
constexpr std::string_view name_of(drive_kind k) { return drive_kinds[static_cast<std::size_t>(k)]; }
constexpr std::string_view name_of(interpolation i) { return interpolations[static_cast<std::size_t>(i)]; }

/// The loops inside the drive, between the controller's command and the actuator.
struct drive_description {
    drive_kind kind = drive_kind::current;
    std::optional<double> velocity_per_V; ///< of a command in volts [m/s a volt]
    std::optional<double> velocity_gain_N_s_per_m, velocity_integral_N_per_m, velocity_filter_Hz;
    std::optional<double> force_limit_N;
    std::optional<double> position_gain_per_s, velocity_feedforward;
    std::optional<double> set_point_period_s;          ///< absent: the sample period
    bool set_point_period_guessed = false;             ///< of a log that fits better so: no file says it
    std::optional<interpolation> between{};            ///< of the set-points; absent: hold
    std::optional<double> position_gain_per_m;         ///< duty a metre (radian), of a position servo
    std::optional<double> minimum_duty, maximum_duty;  ///< absent: 0, 1
    std::optional<double> supply_V;                    ///< at a duty of 1
    std::optional<double> setpoint_rate_limit_m_per_s; ///< of the set-point that is followed; absent: none
    std::optional<double> command_delay_s;             ///< from the row to the drive's use of it
    std::optional<double> set_point_loss;              ///< probability; a lost one repeats the previous
    std::optional<double>
        clock_slip; ///< share that a period of the drive's clock is longer than the controller's; signed

    /// Whether the drive closes a loop of its own around the motor.
    bool closes() const { return kind != drive_kind::current; }
    /// Whether that is a velocity loop, whose gain gives the force.
    bool has_velocity_loop() const { return kind == drive_kind::velocity || kind == drive_kind::position; }
    /// Whether the reference of the log is what the drive receives when there is no command.
    bool takes_position() const { return kind == drive_kind::position || kind == drive_kind::position_servo; }
};

} // namespace quadrant::inline v0::diagnosis
