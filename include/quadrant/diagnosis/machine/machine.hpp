// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/axis_words.hpp"
#include "command_origin.hpp"
#include "controller_description.hpp"
#include "drive_description.hpp"
#include "own_law.hpp"
#include "transmission_description.hpp"

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// What the simulation believes of a machine: the contents of a machine file (schema quadrant.machine/1).
/// Field names are the file's keys, so that a message, the file and the code say the same word; all values SI.
/// An absent optional is an effect that the simulation does not have. A rotary axis has the same fields in rad
/// and N m.
namespace quadrant::inline v0::diagnosis {

struct effect;

/// Motor, moving mass and friction of an axis, as the simulation has them.
struct plant_description {
    double mass_kg = 0;
    double force_constant_N_per_V = 0; ///< newtons per unit of the command column (V, A, or 1 for N)
    double viscous_N_s_per_m = 0;
    double delay_s = 0; ///< from the sample instant to the command's first action; the hold is not part of it
    std::optional<double> coulomb_N;
    std::optional<double> static_N, stribeck_velocity_m_per_s, stribeck_exponent;
    std::optional<double> viscous_asymmetry, coulomb_asymmetry; ///< relative: level times (1 + a sign v)
    std::optional<double> static_asymmetry,
        stribeck_velocity_asymmetry;        ///< the same; absent: the excess and vs are symmetric
    std::optional<double> constant_force_N; ///< added to the motor's force
    std::optional<double> cogging_period_m;
    std::vector<double> cogging_N, cogging_phase_rad; ///< one entry a harmonic
    std::optional<double> presliding_length_m;        ///< deflection at 1 - 1/e of the Coulomb level
    std::optional<double> presliding_damping_s;       ///< of the contact before it slips, over its stiffness
    std::vector<double> gms_weights, gms_stiffness_N_per_m; ///< one entry an element; the weights add up to 1
    /// How fast a slipping element reaches its limit: the attraction C of the Maxwell-slip law. Absent: at
    /// once.
    std::optional<double> gms_attraction_N_per_s;
    std::optional<double> friction_position_amplitude, friction_position_period_m, friction_position_phase_rad;
    std::optional<double> friction_drift, friction_drift_time_s;
    std::optional<double> mode_mass_kg, mode_frequency_Hz, mode_damping; ///< second mass, part of mass_kg
    std::optional<double> backlash_m, spring_N_per_m;
    std::optional<double> backlash_behind_m; ///< play behind an encoder on the motor
    /// Of mass and Coulomb friction what is on the motor's side of the play; absent: all.
    std::optional<double> backlash_motor_mass_kg, backlash_motor_coulomb_N;
    std::optional<double> coupling; ///< this axis' acceleration gains coupling times the other's
    std::optional<double> ripple, ripple_period_m, ripple_phase_rad;
    /// Torque on a rotary axis: -gravity_torque_Nm sin(q - gravity_phase_rad).
    std::optional<double> gravity_torque_Nm, gravity_phase_rad;
    std::optional<double> load_friction; ///< growth of the Coulomb level with the transmitted force

    bool describes_friction() const { return coulomb_N.value_or(0) > 0 || static_N.value_or(0) > 0; }
};

/// A load on an arm that a rotary axis turns: which part of the inertia and of the gravity torque it makes.
struct payload_description {
    std::optional<double> mass_kg, arm_m, link_mass_kg;
};

/// Relative, hard, uniform inside. The key is the file's ("mass", "force_constant", "viscous", "coulomb",
/// "static", ...).
struct tolerance_description {
    std::map<std::string, double> given;
    static constexpr double unstated = 0.05; ///< docs/formats.md: absent means 0.05 and a note
    double of(const std::string& key, double otherwise = unstated) const {
        const auto found = given.find(key);
        return found == given.end() ? otherwise : found->second;
    }
};

/// What amplifier and converter do to a command on its way to the motor.
struct actuator_description {
    std::optional<double> limit_V;
    std::optional<int> dac_bits;
    std::optional<double> dac_range_V; ///< whole range: 20 for +-10 V
    std::optional<double> lag_s{};     ///< first-order current loop
    std::optional<double> drive_limit_V{}, dead_zone_V{};
    std::optional<double> loss_probability{}; ///< of a period in which the drive keeps the previous command
    command_origin command_is = command_origin::asked; ///< where the log's command column was taken
};

/// What the encoder makes of a position.
struct encoder_description {
    double resolution_m = 0; ///< 0: not described
    std::optional<double> cyclic_m, cyclic_period_m,
        cyclic_phase_rad; ///< reading = x + cyclic sin(2 pi x/period + phase)
};

/// Force from the process: mean_N + sum of force_N[i] sin(2 pi (i + 1) fundamental t + phase[i]), t from the
/// first row of a log.
struct process_description {
    std::optional<double> fundamental_Hz, mean_N;
    std::vector<double> force_N, phase_rad;
};

/// Two motors that move one beam, each with a reading at its end. An axis with a plant is then the beam's
/// motion, mean = share y1 + (1 - share) y2 under the sum of both commands; one without is the difference of
/// the readings.
struct gantry_description {
    std::string first, second; ///< axes of the log
    double share = 0.5;        ///< of the mass at the first end, 0 ... 1

    bool operator==(const gantry_description&) const = default;
};

/// One axis of a machine: every box of its loop, and how surely its owner knows the numbers.
struct axis_description {
    std::string name;
    plant_description plant;
    std::string command_unit =
        "V"; ///< "V" or "A", from the force constant's key; "N" ("Nm"): none given, and 1 is meant
    tolerance_description tolerance;
    encoder_description encoder;
    actuator_description actuator;
    process_description process;
    payload_description payload{};
    drive_description drive{};               ///< loops of its own between the command and the motor
    transmission_description transmission{}; ///< between motor and load
    motor_encoder_description motor_encoder{};
    std::optional<gantry_description> gantry_pair{};
    bool positions_only = false; ///< no plant is described: the axis is a chain of positions
    std::optional<controller_description>
        controller; ///< absent or of an unknown kind: diagnosed from the command onwards
    axis_kind kind = axis_kind::linear;
    /// A law that the simulation has, with its values: of an effect of the list, or of the caller's own, which
    /// no file holds.
    struct valued_law {
        const own_law* law;
        own_law::values values;
    };
    std::vector<valued_law> laws{};
    /// Numbers of keys that have neither a member above nor a law, by key (machine_key.hpp).
    std::map<std::string, std::vector<double>, std::less<>> numbers{};
    std::vector<const effect*> own_effects{}; ///< suspects beside those of the list (own_effect.hpp)

    /// Time in which the described velocity loop answers [s]; infinite: none is described.
    double answer_of_loop() const {
        const auto& gain = drive.velocity_gain_N_s_per_m;
        return drive.closes() && gain ? plant.mass_kg / *gain : std::numeric_limits<double>::infinity();
    }
};

/// A whole machine file, checked.
struct machine_description {
    std::string file; ///< where it was read from, for messages
    double sample_period_s = 0;
    std::vector<std::string> excluded_effects;
    std::vector<axis_description> axes; ///< in the order of their names
    std::vector<std::string> notes;     ///< what was assumed while reading
};

} // namespace quadrant::inline v0::diagnosis
