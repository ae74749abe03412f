// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../control/dead_band.hpp"
#include "../friction/slip_contact.hpp"
#include "amplifier_lag.hpp"
#include "joint.hpp"
#include "play_between_masses.hpp"
#include "servo_parameters.hpp"
#include "servo_state.hpp"
#include "sprung_mass.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace quadrant::inline v0 {

/// One axis with whatever sits at its joints: what simulates a machine file, and what the diagnosis fits to a
/// log.
///   command       dead zone, then limit, then lag of the amplifier
///   motor gain    force constant (1 + ripple(x))
///   force         constant - spring x - gravity sin(x - gravity_phase) + cogging(x) + process(t) + M coupling a_other
///   friction      `slip_contact`: Stribeck level by direction, springs that stick and slip; load_friction adds
///                 load_friction |motor - (constant - spring x - gravity sin(x - gravity_phase))| to the level: what a gear
///                 carries between the motor and the forces on its load
///   transmission  `sprung_mass` on the axis; play between motor and load: `backlash`, or with a motor_mass
///                 `play_between_masses`: cogging before it, what else acts and viscous friction behind it, and no
///                 sprung mass or law of a caller beside it
///   reading       load + cyclic(load); with play_behind the motor's
/// A joint that is neutral in every lane costs nothing. Laws: what a caller adds at the joints
/// (`no_joint_laws`: nothing).
/// Source: the laws are those of the blocks named; how they join is docs/formats.md's table of effects.
/// Ports: advance(state, command, surroundings) moves the state on by one step h under a command that is held
/// over it; positive command, force and motion agree. reading(state): what the encoder sees, without its count.
/// State: a value of its own, so that one law moves many axes, and an observer may correct it by shift().
/// Range: that of the laws; a step h > 0. Delays and counts are the caller's: they belong to the sampling.
/// NaN and infinities in a command pass on to the state, for the caller to see. Runs in lanes.
/// Throws "servo_axis.<field> = ...: must ..." and in the names of its laws.
/// Cost: about 40 multiplications, an exponential with Stribeck friction, a sine and a cosine for each sum over
/// position.
/// One friction law and a whole servo period in a block: `linear_motor`.
template <class Real = double, class Laws = no_joint_laws> class servo_axis {
public:
    using described = servo_parameters<Real, Laws>;
    static constexpr std::size_t harmonics = described::harmonics, springs = described::springs;
    using number = parameter_real<Real>; ///< of parameters
    using contact = typename described::contact;
    using mask = mask_of<Real>;
    using repeating = typename described::repeating;
    using parameters = typename described::parameters;

    /// Several axes side by side, one a lane: see servo_parameters.
    template <class AxisOf> static parameters side_by_side(std::size_t count, const AxisOf& axis_of) {
        return described::side_by_side(count, axis_of);
    }
    using state = servo_state<Real, contact, Laws>;
    /// What acts on the axis from outside during a step.
    struct surroundings {
        Real time{0};               ///< at the step's start, from the first row of the log [s]
        Real other_acceleration{0}; ///< of the other axis [m/s^2]
    };

    servo_axis(const parameters& p, Real h) : servo_axis(described::checked(p, h), h, already_checked()) {}
    servo_axis(const parameters& p, Real h, already_checked)
        : h_(h), half_(Real(0.5) * h), mass_(p.mass), force_constant_(p.force_constant),
          dead_zone_(p.dead_zone), limit_(p.limit), constant_(p.constant), spring_(p.spring),
          gravity_(p.gravity), gravity_phase_(p.gravity_phase), load_friction_(p.load_friction),
          coupling_(p.mass * p.coupling), process_mean_(p.process_mean), process_start_(p.process_start),
          drift_(p.drift), inverse_drift_(Real(1) / p.drift_time), half_play_(Real(0.5) * p.play),
          lag_({p.lag}, h, already_checked()), ripple_(p.ripple), cogging_(p.cogging), process_(p.process),
          along_(p.along), cyclic_(p.cyclic), second_(p.second, h, already_checked()),
          apart_(described::masses_apart(p), h, already_checked()), laws_(p.laws),
          inertia_(second_.present() ? p.mass + second_.inertia() : p.mass),
          friction_(p.friction, inertia_, h, already_checked()) {
        has_dead_zone_ = any(greater(dead_zone_, Real(0)));
        has_limit_ = any(less(limit_, Real(std::numeric_limits<double>::infinity())));
        has_spring_ = !all(equal(spring_, Real(0)));
        has_gravity_ = !all(equal(gravity_, Real(0)));
        has_load_friction_ = !all(equal(load_friction_, Real(0)));
        has_coupling_ = !all(equal(coupling_, Real(0)));
        has_drift_ = !all(equal(drift_, Real(0)));
        has_mean_ = !all(equal(process_mean_, Real(0)));
        level_changes_ = along_.present() || has_drift_ || laws_.at(joint::friction);
        parts_ = any(apart_.present());
        half_play_ = select(apart_.present(), Real(0), half_play_);
        sees_motor_ = greater(Real(p.play_behind), Real(0));
        has_motor_encoder_ = any(sees_motor_);
        has_play_ = any(greater(half_play_, Real(0)));
        has_shaper_ = laws_.at(joint::command) || has_dead_zone_ || has_limit_ || lag_.present();
        has_ripple_ = ripple_.present() || laws_.at(joint::motor_gain);
        has_more_force_ =
            cogging_.present() || process_.present() || has_mean_ || has_coupling_ || laws_.at(joint::force);
        has_transmission_ = has_play_ || laws_.at(joint::transmission);
        has_reading_error_ = cyclic_.present() || laws_.at(joint::reading);
    }

    /// One step under a command that is held over it.
    void advance(state& s, Real command, const surroundings& now) const noexcept {
        using std::abs;
        const Real x = s.x + half_ * s.v, time = now.time + half_; // in the middle of the step
        const auto point = [&, v = s.v] { return joint_point<Real>{x, v, command, time, h_}; };
        const Real push = motor(s, command, x, point), pull = load(x);
        Real drive = push + pull, of_motor = push;
        if (has_more_force_) {
            if (cogging_.present()) {
                const Real cogging = cogging_(x);
                drive += cogging;
                of_motor += cogging;
            }
            if (process_.present()) drive += process_(time + process_start_);
            if (has_mean_) drive += process_mean_;
            if (has_coupling_) drive += coupling_ * now.other_acceleration;
            if (laws_.at(joint::force)) drive += laws_(joint::force, point(), s.laws);
        }
        Real momentum = inertia_ * s.v + h_ * drive;
        if (second_.present()) momentum -= second_.impulse(s.second);
        const Real before = s.v;
        const auto stuck = s.friction;
        Real change(0), added(0);
        if (!level_changes_ && !has_load_friction_) {
            s.v = friction_(s.friction, momentum, before);
        } else {
            change = change_of_level(s, time, point);
            if (has_load_friction_) added = load_friction_ * abs(push - pull);
            s.v = has_load_friction_ ? friction_(s.friction, momentum, before, change, added)
                                     : friction_(s.friction, momentum, before, change);
        }
        if (parts_) {
            const Real of_load = drive - of_motor;
            const Real level = friction_.level_at(s.apart.w, of_load, change, added);
            s.take_friction(apart_.part(s.apart, before, s.v, of_motor, of_load, level), stuck);
        }
        if (second_.present()) second_.advance(s.second, before, s.v);
        s.x += half_ * (before + s.v);
        if (has_transmission_)
            transmit(s, point);
        else
            s.load = s.x;
        if (!parts_) return;
        apart_.meet(s.apart, s.x, s.v);
        s.load = select(apart_.present(), s.apart.load, s.load);
    }

    /// What the encoder reads of where the load is [m].
    Real reading(const state& s) const noexcept { return seen(s) + reading_error(s); }
    /// How much of that is not where the encoder sits [m].
    Real reading_error(const state& s) const noexcept {
        Real wrong(0);
        if (!has_reading_error_) return wrong;
        const Real at = seen(s);
        if (cyclic_.present()) wrong += cyclic_(at);
        if (laws_.at(joint::reading))
            wrong += laws_(joint::reading, joint_point<Real>{at, s.v, Real(0), Real(0), h_}, s.laws);
        return wrong;
    }
    bool has_reading_error() const noexcept { return has_reading_error_; }
    /// Where that is which the encoder sits on [m].
    Real seen(const state& s) const noexcept {
        return has_motor_encoder_ ? select(sees_motor_, s.x, s.load) : s.load;
    }
    /// The position that reads so, to the first order of the cyclic error [m].
    Real position_of(Real reading) const noexcept {
        return cyclic_.present() ? reading - cyclic_(reading) : reading;
    }
    /// Velocity of what the encoder sits on [m/s].
    Real seen_velocity(const state& s) const noexcept {
        const Real v = has_play_ ? select(either(s.carried, equal(half_play_, Real(0))), s.v, Real(0)) : s.v;
        return parts_ ? select(both(apart_.present(), !sees_motor_), s.apart.w, v) : v;
    }
    Real mass() const noexcept { return mass_; }

private:
    /// `point`: makes the joint_point, where a law asks for it.
    Real motor(state& s, Real command, Real x, const auto& point) const noexcept {
        if (has_shaper_) {
            if (laws_.at(joint::command)) command += laws_(joint::command, point(), s.laws);
            if (has_dead_zone_) command = detail::beyond(command, dead_zone_);
            if (has_limit_) command = limited_to(command, limit_);
            if (lag_.present()) command = lag_(s.current, command);
        }
        if (!has_ripple_) return force_constant_ * command;
        Real gain = force_constant_;
        if (ripple_.present()) gain = gain * (Real(1) + ripple_(x));
        if (laws_.at(joint::motor_gain)) gain = gain * (Real(1) + laws_(joint::motor_gain, point(), s.laws));
        return gain * command;
    }
    /// What acts on the load whether it moves or not [N].
    Real load(Real x) const noexcept {
        using std::sin;
        Real out = constant_;
        if (has_spring_) out -= spring_ * x;
        if (has_gravity_) out -= gravity_ * sin(x - gravity_phase_);
        return out;
    }
    /// Relative change of the friction's level here and now; never below -1, a level of zero.
    Real change_of_level(state& s, Real time, const auto& point) const noexcept {
        using std::exp;
        Real factor(1);
        const auto times = [&](Real change) {
            const Real f = Real(1) + change;
            factor = factor * select(greater(f, Real(0)), f, Real(0));
        };
        if (along_.present()) times(along_(s.x));
        if (has_drift_) times(drift_ * (Real(1) - exp(-time * inverse_drift_)));
        if (laws_.at(joint::friction)) times(laws_(joint::friction, point(), s.laws));
        return factor - Real(1);
    }
    /// The play operator of `backlash`, and whether the motor carries the load.
    void transmit(state& s, const auto& point) const noexcept {
        Real motor = s.x;
        if (laws_.at(joint::transmission)) motor += laws_(joint::transmission, point(), s.laws);
        if (!has_play_) {
            s.load = motor;
            return;
        }
        const Real before = s.load;
        s.load = limited_to(before, motor - half_play_, motor + half_play_);
        s.carried = !equal(s.load, before);
    }

    Real h_, half_, mass_, force_constant_, dead_zone_, limit_, constant_, spring_, gravity_, gravity_phase_,
        load_friction_, coupling_, process_mean_, process_start_, drift_, inverse_drift_, half_play_;
    amplifier_lag<Real> lag_;
    typename described::sum ripple_, cogging_, process_, along_, cyclic_;
    sprung_mass<Real> second_;
    play_between_masses<Real> apart_;
    mask sees_motor_{};
    Laws laws_;
    Real inertia_;
    contact friction_;
    bool has_dead_zone_ = false, has_limit_ = false, has_spring_ = false, has_gravity_ = false,
         has_load_friction_ = false, has_coupling_ = false, has_drift_ = false, has_play_ = false,
         has_mean_ = false, level_changes_ = false;
    bool has_shaper_ = false, has_ripple_ = false, has_more_force_ = false, has_transmission_ = false,
         has_reading_error_ = false, parts_ = false,
         has_motor_encoder_ = false; ///< whether any of what may sit at this joint is there
};

} // namespace quadrant::inline v0
