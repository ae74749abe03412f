// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/command_origin.hpp"
#include "../text/axis_words.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis {

struct driven_motion;

/// How two motors turn the beam that they move: the part of their commands that does not move it,
/// w = (1 - share) u1 - share u2.
struct beam_turn {
    std::string first, second;     ///< axes of its ends
    double share = 0.5;            ///< of the mass at the first
    std::vector<double> command{}; ///< empty: their commands are no forces
};

/// One axis of a servo log: one entry a sample, SI (a rotary axis: rad for m, N m for N).
struct axis_log {
    std::string name;
    bool still = false; ///< neither reference nor position ever changes: a parked axis
    /// "V", "A" or "N" ("Nm" of a rotary axis); of a drive with loops of its own also "m_per_s", "rad_per_s",
    /// "m", "rad" or "duty";
    /// empty: no command was recorded.
    std::string command_unit = "V";
    std::vector<double> reference; ///< position reference [m]
    std::vector<double> position;  ///< position as the controller read it [m]
    std::vector<double> command;   ///< controller output of that row, after limit and DAC
    std::vector<double> reference_velocity{}, reference_acceleration{}; ///< empty: differences of the reference
    std::vector<double> velocity{}; ///< as the controller read it [m/s]; empty: differences of the position
    /// Of the axis that may be coupled to this one, over the row [m/s^2]; empty: alone.
    std::vector<double> other_acceleration{};
    double reference_step = 0; ///< half of the last written digit bounds the rounding of the column; 0: exact
    double position_step = 0;  ///< the same for the position column
    double command_step = 0;   ///< the same for the command column
    axis_kind kind = axis_kind::linear;
    /// Of each row: 1 where there is no reading that counts (a missing row, a wrong or repeated reading, the
    /// drive off). The position is then filled in and nothing is evaluated on it. Empty: every row counts.
    std::vector<unsigned char> left_out{};
    /// Whether the log has a position reference. Without, `reference` is the integral of the reference's speed
    /// where the log has that, else the position, and nothing is said of the controller.
    bool has_reference = true;
    /// Whether each sample is what the controller saw and did. Not so where the log was resampled: the
    /// controller cannot be replayed then.
    bool as_sampled = true;
    command_origin command_is = command_origin::asked; ///< what the column's name says of it
    std::vector<double> duty{};                        ///< of the drive's bridge, -1 to 1; empty: not recorded
    std::vector<double> effort{}; ///< measured current, force or torque beside a command; empty: not recorded
    std::string effort_unit{};    ///< "A", "N" or "Nm"
    double duty_step = 0, effort_step = 0;
    std::vector<double> motor{}; ///< a second encoder, on the motor; empty: none
    std::string motor_unit{};    ///< "rad" of the motor's turn, or "m": in units of the load
    double motor_step = 0;
    /// Displacement of a sticking axis that says nothing of its contact: `position` is that of parts that move
    /// against each other [m].
    double least_give = 0;
    std::vector<double>
        controller_reads{}; ///< where `position` is not what the controller read: that; else empty
    /// Of each row: 1 where the drive is switched off, 2 where nobody read the row either; empty: never off.
    std::vector<unsigned char> drive_off{};
    /// Of an axis whose drive closes loops of its own (with_drives()): `command` is then what the actuator got,
    /// as measured or as the described drive made it, and this is what the drive received and saw.
    std::shared_ptr<const driven_motion> drive{};
    std::vector<double> asked{};             ///< then: the controller's output, as logged
    std::shared_ptr<const beam_turn> turn{}; ///< of two motors on one beam (join_gantry_pairs())
};

/// The motion of an axis: that of its reference, or its own where the reference stands still (an axis that is
/// moved by hand or by gravity).
inline const std::vector<double>& motion_of(const axis_log& log) {
    const auto& r = log.reference;
    const bool stands = std::all_of(r.begin(), r.end(), [&](double x) { return x == r.front(); });
    return stands ? log.position : r;
}

/// A servo log (CSV, docs/formats.md). Sample k means t = k T.
struct machine_log {
    std::string file;
    double sample_period_s = 0; ///< mean of the stamps' differences
    std::size_t samples = 0;
    std::vector<axis_log> axes;     ///< in the order of their names
    std::vector<axis_log> beside{}; ///< axes that the machine file does not describe (keep_described())
    std::vector<std::string> notes;
};

} // namespace quadrant::inline v0::diagnosis
