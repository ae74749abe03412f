// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/controller/kinds.hpp>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// A virtual machine as its file describes it (schema quadrant.cnc/1). Field names are the file's keys; all
/// values SI.
namespace quadrant_cnc {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Of one axis, or along the path.
struct limits_description {
    double velocity_m_per_s = unlimited, acceleration_m_per_s2 = unlimited, jerk_m_per_s3 = unlimited;
};

/// Friction of a screw drive in one direction: static e^(-w/fall) + coulomb (1 - e^(-w/rise)).
struct friction_side {
    double static_Nm = 0, coulomb_Nm = 0, fall_rad_per_s = 1, rise_rad_per_s = 1;
};

struct ball_screw_description {
    double amplifier_A_per_V = 0, torque_constant_Nm_per_A = 0, inertia_kg_m2 = 0, viscous_Nm_s_per_rad = 0,
           pitch_m = 0;
    std::optional<double> current_limit_A;
    double lead_error = 0; ///< relative: what a turn gives too much
    double table_mass_kg = 0, compliance_m_per_N = 0, backlash_m = 0;
    friction_side forward, backward;
};

struct linear_motor_description {
    double mass_kg = 0, force_constant_N_per_V = 0, viscous_N_s_per_m = 0, delay_s = 0;
    double coulomb_N = 0;
    std::optional<double> static_N, stribeck_velocity_m_per_s;
    std::optional<double> drive_limit_V;
    std::optional<double> amplifier_A_per_V; ///< only to report the current
};

struct sensor_description {
    double resolution_m = 0, noise_m = 0; ///< of the encoder
    bool on_motor = false;                ///< the encoder does not see lead error, screw and play
    double tachometer_noise_m_per_s = 0, accelerometer_noise_m_per_s2 = 0;
};

struct command_description {
    double limit_V = 0;
    std::optional<int> dac_bits;
    std::optional<double> dac_range_V; ///< whole range: 20 for +-10 V
};

/// The drive's own friction, added to the command as the reference will cause it.
struct friction_feedforward_description {
    double scale = 1, width_m_per_s = 1e-3;
};

/// What the cutter does to an axis in feed moves: mean and harmonics of the spindle; positive: forward.
struct cutting_load_description {
    static constexpr std::size_t most_harmonics = 32;
    double spindle_Hz = 0, entry_s = 0; ///< turns per second; in which the tool enters or leaves the cut
    bool torque = false;                ///< in N m on the screw; else in N on the table
    double mean = 0;
    std::vector<double> cosine, sine; ///< of harmonic 1, 2, ...
};

/// What the axis accelerates less than it is asked to, added to the command behind a filter.
struct acceleration_feedback_description {
    double gain_V_s2_per_m = 0, filter_Hz = 0;
};

struct axis_description {
    std::size_t axis = 0; ///< 0, 1, 2 is x, y, z
    std::string path;     ///< of its keys, for messages
    double from_m = -unlimited, to_m = unlimited;
    limits_description limits;
    std::variant<ball_screw_description, linear_motor_description> drive;
    sensor_description sensor;
    command_description command;
    quadrant::diagnosis::controller_description law; ///< whole: what the file leaves to the drive is in it
    std::optional<acceleration_feedback_description> acceleration;
    std::optional<cutting_load_description> load;

    const char* name() const { return axis == 0 ? "x" : axis == 1 ? "y" : "z"; }
    /// Its law reads the velocities of trajectory and tachometer: whoever replays it needs them.
    bool motion_is_logged() const { return quadrant::diagnosis::kind_of(law).motions; }
    double dac_step() const {
        return command.dac_bits ? *command.dac_range_V / double(1ULL << *command.dac_bits) : 0;
    }
};

enum class profile : unsigned char {
    constant_velocity,
    constant_acceleration,
    trapezoidal_acceleration,
    cubic_acceleration
};

struct trajectory_description {
    quadrant_cnc::profile profile = quadrant_cnc::profile::trapezoidal_acceleration;
    limits_description limits; ///< along the path
    std::array<double, 3> start_m{};
    std::optional<double> corner_tolerance_m; ///< absent: moves end in a stop until the program says otherwise
    bool reach_the_feed = false;              ///< refuse a block that is too short for it
};

struct cnc_description {
    std::string file;
    double servo_period_s = 0;
    unsigned seed = 1;
    trajectory_description trajectory;
    std::vector<axis_description> axes; ///< in the order of their names
};

} // namespace quadrant_cnc
