// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant/diagnosis/machine/drive_description.hpp"
#include "quadrant/diagnosis/machine/own_law.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// The machines of the trial as they are, not as they are described. All values SI. Nothing here comes from the
/// diagnosis but the laws of effects that this simulator has no law of its own for.
namespace quadrant_gap::trial {

/// A force, a gain or an error that repeats along the travel: sum of size[i] sin(2 pi (i + 1) x / period +
/// phase[i]).
struct wave {
    double period = 1;
    std::vector<double> size{}, phase{};
};

enum class contact_law { lugre, dahl, maxwell_slip, tanh_spring };
enum class stribeck_shape { exponential, gaussian, lorentzian };

struct friction_truth {
    double coulomb = 0, level_at_rest = 0,
           stribeck_velocity = 0.003; ///< level_at_rest: 0 without a Stribeck effect
    stribeck_shape shape = stribeck_shape::exponential;
    double viscous = 0, viscous_asymmetry = 0, coulomb_asymmetry = 0;
    wave along{};                     ///< relative, of the Coulomb level
    double drift = 0, drift_time = 5; ///< relative, of the Coulomb level
    double load = 0;                  ///< growth of the level with the transmitted force
    contact_law law = contact_law::lugre;
    double length = 3e-7;                  ///< deflection at 63 % of the level, loaded for the first time
    double exponent = 1;                   ///< of Dahl
    std::vector<double> weights{}, ways{}; ///< Maxwell-slip: shares of the level, relative paths to slip
    double damping = 0.2;                  ///< of the contact, relative
};

/// At rest no less friction than in motion.
inline void keep_level_at_rest(friction_truth& f) {
    if (f.level_at_rest > 0) f.level_at_rest = std::max(f.level_at_rest, f.coulomb);
}

struct actuator_truth {
    double force_constant = 0, delay = 0, lag = 0, drive_limit = 1e9, dead_zone = 0, loss = 0;
    double slew = 0;       ///< [V/s], 0: none; in no list
    double soft_limit = 0; ///< [V] where the force constant has lost half, 0: none; in no list
    wave ripple{};         ///< relative
};

/// A load at the end of an arm that the axis turns.
struct arm_truth {
    double mass = 0, arm = 0;
    double inertia() const { return mass * arm * arm; }
    double weight() const { return 9.80665 * mass * arm; } ///< torque of it, level
};

struct mechanics_truth {
    double mass = 0;                                                ///< all that moves
    double mode_mass = 0, mode_frequency = 60, mode_damping = 0.02; ///< part of mass, not under the encoder
    double backlash = 0, spring = 0, constant_force = 0, coupling = 0;
    wave cogging{};
    double gravity = 0, gravity_phase = 0; ///< torque -gravity sin(x - phase)
    /// The load on the arm, and that which mass and gravity hold already.
    arm_truth payload{}, payload_as_described{};

    double moving() const { return mass + payload.inertia() - payload_as_described.inertia(); }
    double weight() const { return gravity + payload.weight() - payload_as_described.weight(); }
};

struct encoder_truth {
    double resolution = 0, noise = 0, noise_colour = 0; ///< rms [m]; pole of the coloured half
    wave cyclic{};
};

struct process_truth {
    double fundamental = 0; ///< [Hz], 0: no cutting
    double mean = 0;
    std::vector<double> size{}, phase{};
};

/// What no diagnosis has a name for.
struct stranger {
    enum class kind { none, ramp, bump, quadratic_spring, step, bursts, wander } what = kind::none;
    double size = 0;  ///< [N] at its scale
    double scale = 1; ///< [m/s], [m] or [s]
    double begin = 0; ///< [s] or [m]
    std::uint64_t seed = 0;
};

struct controller_truth {
    double position_gain = 0, velocity_gain = 0, integral = 0, filter_Hz = 0;
    bool two_sample_mean = false;
    double velocity_feedforward = 1, acceleration_feedforward = 0, viscous_feedforward = 0,
           coulomb_feedforward = 0;
    double notch_Hz = 0, notch_damping = 0; ///< 0 Hz: no notch
    double limit = 10, dac_range = 20;
    int dac_bits = 16; ///< 0: no rounding
};

/// A drive with loops of its own. It closes them on the motor, in the fine steps.
struct drive_truth {
    using drive_kind = quadrant::diagnosis::drive_kind;
    drive_kind kind = drive_kind::current;
    double velocity_per_V = 0, velocity_gain = 0, velocity_integral = 0, force_limit = 0; ///< limit 0: none
    double position_gain = 0;                                                             ///< [1/s]
    double duty_gain = 0, supply = 0, minimum_duty = 0, maximum_duty = 1, rate_limit = 0; ///< rate 0: none
    double delay = 0, loss = 0, clock_slip = 0;
    double began = 0;    ///< force of the velocity integral as the log begins
    bool linear = false; ///< set-points drawn as a line
    /// What is measured behind its loops is in the log, too: the duty, or the current; the latter as each row
    /// begins, or as the mean of the row.
    bool tapped = false, tap_is_mean = false;

    bool closes() const { return kind != drive_kind::current; }
    bool shows_current() const { return tapped && closes() && kind != drive_kind::position_servo; }
};

/// The law of an effect of the list, with its true numbers.
struct law_truth {
    const quadrant::diagnosis::own_law* law = nullptr;
    quadrant::diagnosis::own_law::values values{};
};

/// A joint of an arm goes ten radians where a linear axis goes a metre: its contacts, its creeping and its
/// Stribeck velocity are as many times larger in number.
inline constexpr double radians_for_a_metre = 10;

struct axis_truth {
    std::string name = "x";
    bool turns = false; ///< a rotary axis: rad for m, N m for N in all that follows
    mechanics_truth mechanics{};
    friction_truth friction{};
    actuator_truth actuator{};
    encoder_truth encoder{};
    process_truth process{};
    stranger unknown{};
    controller_truth controller{};
    drive_truth drive{};
    std::vector<law_truth> laws{};
};

} // namespace quadrant_gap::trial
