// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "drive_model.hpp"
#include "friction_contact.hpp"
#include "harmonics.hpp"

#include <array>
#include <limits>

namespace quadrant::inline v0::diagnosis {

/// A point mass at the end of a slender link, which turns about the other end.
struct arm_load {
    double mass = 0, arm = 0, link_mass = 0; ///< [kg], [m], [kg]

    double inertia() const { return (mass + link_mass / 3) * arm * arm; } ///< [kg m^2]
    /// Torque of its weight when the arm is level [N m].
    double gravity() const { return (mass + link_mass / 2) * 9.80665 * arm; }
};

/// The plant that the diagnosis simulates: the described machine plus whatever the effects under trial join to
/// it. Boxes in the order of the loop; every member is neutral when its effect is absent. SI numbers.
struct plant_model {
    static constexpr std::size_t max_harmonics = harmonics::most;

    drive_model drive, drive_as_described; ///< what closes loops of its own between command and actuator
    // actuator
    double delay = 0;     ///< [s]
    double loss = 0;      ///< probability that a period keeps the previous command
    double dead_zone = 0; ///< [V]
    double drive_limit = std::numeric_limits<double>::infinity(); ///< [V]
    double lag = 0;                                               ///< first-order current loop [s]
    double force_constant = 0;                                    ///< [N/V]
    harmonics ripple; ///< of the force constant, relative, over position
    // mechanics
    double mass = 0; ///< all that moves, the mode's part too [kg]
    /// Friction that opposes the motion: Stribeck curve, asymmetry, contact, change over place and time.
    struct friction_box {
        double viscous_slope = 0;                            ///< [N s/m]
        double coulomb = 0;                                  ///< [N]
        double excess = 0;                                   ///< static minus Coulomb level [N]
        double stribeck_velocity = 1;                        ///< [m/s]
        double stribeck_exponent = 1;                        ///< of the speed over it
        double viscous_asymmetry = 0;                        ///< relative, signed
        double coulomb_asymmetry = 0;                        ///< relative, signed
        double excess_asymmetry = 0, velocity_asymmetry = 0; ///< of excess and Stribeck velocity
        friction_contact contact;
        harmonics along;                       ///< of the Coulomb level, relative, over position
        double load = 0;                       ///< growth of the level with the transmitted force
        double drift_rate = 0, drift_time = 1; ///< Coulomb level times 1 + drift() (1 - exp(-t/drift_time))
        /// Where it ends. A log much shorter than drift_time tells the rate, and says little of the end.
        double drift() const { return std::max(-0.95, drift_rate * drift_time); }
        /// Stiffness of a spring of the contact: its share of the breakaway level over its length [N/m].
        double stiffness(std::size_t i) const {
            const double level = std::max(0.0, coulomb + excess);
            return i < contact.elements && level > 0 ? contact.weights[i] * level / contact.lengths()[i] : 0;
        }
    } friction;
    double constant_force = 0; ///< [N]
    double spring = 0;         ///< [N/m], about position 0
    /// Of an axis that carries its weight round: torque -torque sin(q - phase).
    struct gravity_box {
        double torque = 0, phase = 0; ///< [N m], [rad]
    } gravity;
    /// The load on the arm, and that which `mass` and `gravity.torque` hold already.
    arm_load payload, payload_as_described;
    bool turns_level = true; ///< no gravity is described: the payload turns in a level plane
    double coupling = 0;     ///< of the other axis' acceleration
    harmonics cogging;       ///< [N] over position
    own_laws own;            ///< laws of effects that have no member here
    /// A second mass on a spring, not seen by the encoder.
    struct mode_box {
        double mass = 0, frequency_Hz = 100, damping = 0.02; ///< frequency and damping with the first mass held
    } mode;
    double backlash = 0;        ///< play between motor and encoder [m]
    double backlash_behind = 0; ///< play behind the encoder, which sits on the motor [m]
    /// Of the mass [kg] and of the friction's level [N] what is on the motor's side of the play; all of it
    /// where nothing is said.
    double motor_mass = std::numeric_limits<double>::infinity(),
           motor_coulomb = std::numeric_limits<double>::infinity();
    // process
    harmonics cutting;        ///< [N] over time
    double cutting_mean = 0;  ///< [N]
    double cutting_start = 0; ///< time of the process at the first row [s]
    // sensor
    harmonics cyclic; ///< [m] over position

    /// All that moves, with the payload as it is [kg]; the rotor has a hundredth of the inertia at least.
    double moving_mass() const {
        return std::max(mass + payload.inertia() - payload_as_described.inertia(), 0.01 * mass);
    }
    /// The mode's part of it. A search may take the one below the other: then it is what a mode can have at
    /// most.
    double second_mass() const { return std::min(mode.mass, 0.95 * moving_mass()); }
    /// Largest torque of gravity, with the payload as it is [N m].
    double weight() const {
        return turns_level ? gravity.torque
                           : std::max(gravity.torque + payload.gravity() - payload_as_described.gravity(), 0.0);
    }
    /// Infinite where the play has no masses; nor has it beside a mode [kg].
    double mass_before_the_play() const {
        if (!play_has_masses() || mode.mass > 0) return std::numeric_limits<double>::infinity();
        return std::min(motor_mass, 0.99 * moving_mass());
    }
    /// Whether motor and load are bodies of their own at the play.
    bool play_has_masses() const { return motor_mass < std::numeric_limits<double>::infinity(); }
    bool has_play() const { return backlash > 0 || backlash_behind > 0; }
    /// What acts on the load at a position whether the axis moves or not [N].
    double static_force(double position) const {
        return constant_force - spring * position - weight() * std::sin(position - gravity.phase);
    }
    /// All that repeats: along the travel, and with the process in time.
    std::array<harmonics*, 5> waves() { return {&ripple, &cogging, &cutting, &cyclic, &friction.along}; }
    /// Force that keeps the load at rest at a position, a process running [N].
    double holding_force(double position) const { return -(static_force(position) + cutting_mean); }

    plant_model() = default;
    /// `give`: of a contact that is not described, or gives way by less, record_scales::give() [m].
    plant_model(const plant_description& d, double give) {
        axis_description a;
        a.plant = d;
        *this = plant_model(a, give);
    }
    plant_model(const axis_description& a, double give) {
        const plant_description& d = a.plant;
        drive = drive_as_described = drive_model(a.drive);
        delay = d.delay_s;
        loss = a.actuator.loss_probability.value_or(0);
        dead_zone = a.actuator.dead_zone_V.value_or(0);
        drive_limit = a.actuator.drive_limit_V.value_or(drive_limit);
        lag = a.actuator.lag_s.value_or(0);
        force_constant = d.force_constant_N_per_V;
        ripple = one(d.ripple, d.ripple_period_m, d.ripple_phase_rad);
        mass = d.mass_kg;
        friction.viscous_slope = d.viscous_N_s_per_m;
        friction.coulomb = d.coulomb_N.value_or(0);
        friction.excess = d.static_N ? *d.static_N - friction.coulomb : 0;
        friction.stribeck_velocity = d.stribeck_velocity_m_per_s.value_or(1);
        friction.stribeck_exponent = d.stribeck_exponent.value_or(1);
        friction.viscous_asymmetry = d.viscous_asymmetry.value_or(0);
        friction.coulomb_asymmetry = d.coulomb_asymmetry.value_or(0);
        friction.velocity_asymmetry = d.stribeck_velocity_asymmetry.value_or(0);
        if (d.static_asymmetry &&
            friction.excess > 0) // of the static level; the excess is what it has above the other
            friction.excess_asymmetry =
                std::clamp((*d.static_N * *d.static_asymmetry - friction.coulomb * friction.coulomb_asymmetry) /
                               friction.excess,
                           -1.0, 1.0);
        friction.contact.length = give;
        if (d.presliding_length_m.value_or(0) > give) friction.contact.exponential(*d.presliding_length_m);
        if (!d.gms_weights.empty()) describe_contact(d, give);
        friction.contact.attraction = d.gms_attraction_N_per_s.value_or(friction.contact.attraction);
        friction.contact.damping = d.presliding_damping_s.value_or(0);
        friction.along =
            one(d.friction_position_amplitude, d.friction_position_period_m, d.friction_position_phase_rad);
        friction.drift_time = d.friction_drift_time_s.value_or(1);
        friction.drift_rate = d.friction_drift.value_or(0) / friction.drift_time;
        constant_force = d.constant_force_N.value_or(0);
        spring = d.spring_N_per_m.value_or(0);
        gravity = {d.gravity_torque_Nm.value_or(0), d.gravity_phase_rad.value_or(0)};
        turns_level = !d.gravity_torque_Nm;
        payload = payload_as_described = {a.payload.mass_kg.value_or(0), a.payload.arm_m.value_or(0),
                                          a.payload.link_mass_kg.value_or(0)};
        friction.load = d.load_friction.value_or(0);
        coupling = d.coupling.value_or(0);
        cogging = {d.cogging_period_m.value_or(0), d.cogging_N, d.cogging_phase_rad};
        if (d.mode_mass_kg)
            mode = {*d.mode_mass_kg, d.mode_frequency_Hz.value_or(mode.frequency_Hz),
                    d.mode_damping.value_or(mode.damping)};
        backlash = d.backlash_m.value_or(0);
        backlash_behind = d.backlash_behind_m.value_or(0);
        motor_mass = d.backlash_motor_mass_kg.value_or(motor_mass);
        motor_coulomb = d.backlash_motor_coulomb_N.value_or(motor_coulomb);
        if (a.process.fundamental_Hz)
            cutting = {1 / *a.process.fundamental_Hz, a.process.force_N, a.process.phase_rad};
        cutting_mean = a.process.mean_N.value_or(0);
        cyclic = one(a.encoder.cyclic_m, a.encoder.cyclic_period_m, a.encoder.cyclic_phase_rad);
        for (const auto& l : a.laws) own.of(*l.law) = l.values;
    }

private:
    static harmonics one(const std::optional<double>& size, const std::optional<double>& period,
                         const std::optional<double>& phase) {
        if (!size) return {};
        return {period.value_or(0), {*size}, {phase.value_or(0)}};
    }
    void describe_contact(const plant_description& d, double give) {
        const double level = friction.coulomb + friction.excess;
        if (!(level > 0)) return; // no friction that could give way
        const std::size_t elements = std::min(d.gms_weights.size(), friction_contact::most);
        const auto length = [&](std::size_t i) {
            return d.gms_weights[i] * level / d.gms_stiffness_N_per_m[i];
        };
        double longest = 0;
        for (std::size_t i = 0; i < elements; ++i) longest = std::max(longest, length(i));
        if (longest <= give) return; // no record shows it
        auto& c = friction.contact;
        c.elements = elements;
        double logarithm = 0;
        for (std::size_t i = 0; i < c.elements; ++i) {
            c.weights[i] = d.gms_weights[i];
            c.lengths_as_described[i] = length(i);
            logarithm += std::log(c.lengths_as_described[i]) / static_cast<double>(c.elements);
        }
        c.length = std::exp(logarithm);
        if (c.elements == 1) c.lengths_as_described = {}; // the length says it
    }
};

} // namespace quadrant::inline v0::diagnosis
