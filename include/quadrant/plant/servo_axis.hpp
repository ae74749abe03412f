// SPDX-License-Identifier: BSL-1.0
// Long: one plant: side_by_side() names each of its parameters, and its step each of its forces.
#pragma once
#include "../control/dead_band.hpp"
#include "../friction/slip_contact.hpp"
#include "amplifier_lag.hpp"
#include "harmonic_series.hpp"
#include "joint.hpp"
#include "sprung_mass.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace quadrant::inline v0 {

/// One axis with whatever sits at its joints: what simulates a machine file, and what the diagnosis fits to a
/// log.
///   command       dead zone, then limit, then lag of the amplifier
///   motor gain    force constant (1 + ripple(x))
///   force         constant - spring x - gravity sin(x - gravity_phase) + cogging(x) + process(t) + M coupling a_other
///   friction      `slip_contact`: Stribeck level by direction, springs that stick and slip; load_friction adds
///                 load_friction |motor - (constant - spring x - gravity sin(x - gravity_phase))| to the level: what a gear
///                 carries between the motor and the forces on its load
///   transmission  `sprung_mass` on the axis; play between motor and load
///   reading       load + cyclic(load)
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
    static constexpr std::size_t harmonics = 8, springs = 4;
    using number = parameter_real<Real>; ///< of parameters
    using contact = slip_contact<springs, Real>;
    using mask = mask_of<Real>;

    /// What repeats over a place or a time: period, and cosine and sine of each harmonic. Its unit is that of
    /// the joint.
    struct repeating {
        number period{1};                               ///< [m] or [s]; > 0
        std::array<number, harmonics> cosine{}, sine{}; ///< finite
    };
    /// Bare SI numbers: a fit moves each of them. Neutral as they stand, but for mass and force constant.
    struct parameters {
        number mass{1};           ///< all that moves, the sprung mass too [kg]
        number force_constant{1}; ///< [N] of a unit of the command
        number dead_zone{0};      ///< [unit of the command]
        number limit{std::numeric_limits<double>::infinity()};
        quantity<si::time, number> lag{};
        repeating ripple{};                       ///< of the force constant, relative, over position
        number constant{0};                       ///< [N]
        number spring{0};                         ///< [N/m], about position 0
        number gravity{0}, gravity_phase{0};      ///< [N m], [rad], of an axis whose position is an angle
        number coupling{0};                       ///< of the other axis' acceleration
        repeating cogging{};                      ///< [N] over position
        repeating process{};                      ///< [N] over time
        number process_mean{0}, process_start{0}; ///< [N], [s]
        typename contact::parameters friction{};
        repeating along{};              ///< of the friction's level, relative, over position
        number drift{0}, drift_time{1}; ///< level times 1 + drift (1 - exp(-t/drift_time))
        number load_friction{0};        ///< growth of the level with the force that the drive transmits; >= 0
        typename sprung_mass<Real>::parameters second{};
        number play{0};     ///< between motor and load [m]
        repeating cyclic{}; ///< of the reading [m] over position
        Laws laws{};
    };
    /// Several axes side by side, one a lane; the last one again in the lanes that are left over.
    /// `axis_of(i)`: the parameters of axis i < `count`, a servo_axis in double.
    template <class AxisOf> static parameters side_by_side(std::size_t count, const AxisOf& axis_of) {
        using Single = std::remove_cvref_t<decltype(axis_of(0))>;
        const auto each = [&](const auto& number_of) {
            number out(0);
            for (std::size_t i = 0; i < lane_count<Real>; ++i)
                set_lane(out, i, number_of(axis_of(i < count ? i : count - 1)));
            return out;
        };
        const auto typed = [&]<class Quantity>(Quantity& to, const auto& quantity_of) {
            to = Quantity::from_value(each([&](const Single& p) { return quantity_of(p).value(); }));
        };
        const auto waves = [&](const auto& of) {
            repeating out;
            out.period = each([&](const Single& p) { return of(p).period; });
            for (std::size_t i = 0; i < harmonics; ++i) {
                out.cosine[i] = each([&](const Single& p) { return of(p).cosine[i]; });
                out.sine[i] = each([&](const Single& p) { return of(p).sine[i]; });
            }
            return out;
        };
        parameters out;
        out.mass = each([](const Single& p) { return p.mass; });
        out.force_constant = each([](const Single& p) { return p.force_constant; });
        out.dead_zone = each([](const Single& p) { return p.dead_zone; });
        out.limit = each([](const Single& p) { return p.limit; });
        typed(out.lag, [](const Single& p) { return p.lag; });
        out.ripple = waves([](const Single& p) -> auto& { return p.ripple; });
        out.constant = each([](const Single& p) { return p.constant; });
        out.spring = each([](const Single& p) { return p.spring; });
        out.gravity = each([](const Single& p) { return p.gravity; });
        out.gravity_phase = each([](const Single& p) { return p.gravity_phase; });
        out.load_friction = each([](const Single& p) { return p.load_friction; });
        out.coupling = each([](const Single& p) { return p.coupling; });
        out.cogging = waves([](const Single& p) -> auto& { return p.cogging; });
        out.process = waves([](const Single& p) -> auto& { return p.process; });
        out.process_mean = each([](const Single& p) { return p.process_mean; });
        out.process_start = each([](const Single& p) { return p.process_start; });
        out.along = waves([](const Single& p) -> auto& { return p.along; });
        out.drift = each([](const Single& p) { return p.drift; });
        out.drift_time = each([](const Single& p) { return p.drift_time; });
        out.play = each([](const Single& p) { return p.play; });
        out.cyclic = waves([](const Single& p) -> auto& { return p.cyclic; });
        typed(out.second.mass, [](const Single& p) { return p.second.mass; });
        typed(out.second.centre, [](const Single& p) { return p.second.centre; });
        out.second.damping = each([](const Single& p) { return p.second.damping; });
        auto& f = out.friction;
        typed(f.level, [](const Single& p) { return p.friction.level; });
        typed(f.excess, [](const Single& p) { return p.friction.excess; });
        typed(f.stribeck_velocity, [](const Single& p) { return p.friction.stribeck_velocity; });
        f.shape = each([](const Single& p) { return p.friction.shape; });
        typed(f.viscous, [](const Single& p) { return p.friction.viscous; });
        f.asymmetry = each([](const Single& p) { return p.friction.asymmetry; });
        f.excess_asymmetry = each([](const Single& p) { return p.friction.excess_asymmetry; });
        f.velocity_asymmetry = each([](const Single& p) { return p.friction.velocity_asymmetry; });
        f.viscous_asymmetry = each([](const Single& p) { return p.friction.viscous_asymmetry; });
        typed(f.attraction, [](const Single& p) { return p.friction.attraction; });
        typed(f.damping, [](const Single& p) { return p.friction.damping; });
        for (std::size_t i = 0; i < springs; ++i) {
            f.weights[i] = each([&](const Single& p) { return p.friction.weights[i]; });
            typed(f.stiffness[i], [&](const Single& p) { return p.friction.stiffness[i]; });
            typed(f.give[i], [&](const Single& p) { return p.friction.give[i]; });
        }
        if constexpr (requires { Laws(count, axis_of); }) out.laws = Laws(count, axis_of);
        return out;
    }
    /// Motion of motor and load, and what the joints remember.
    struct state {
        Real x{0}, v{0}; ///< of the motor [m], [m/s]
        Real load{0};    ///< where the encoder is [m]
        mask carried{};  ///< the motor moves the load: the play is crossed
        Real current{0}; ///< behind the amplifier's lag
        typename sprung_mass<Real>::state second{};
        typename contact::state friction{};
        typename Laws::state laws{};

        /// An observer's correction moves the whole axis.
        void shift(Real dx, Real dv) noexcept {
            x += dx;
            load += dx;
            v += dv;
        }
        /// Another state in the lanes that `here` picks.
        void take(const mask& here, const state& other) noexcept {
            const auto put = [&](Real& to, const Real& from) { to = select(here, from, to); };
            const auto choose = [&](mask& to, const mask& from) {
                to = either(both(here, from), both(!here, to));
            };
            put(x, other.x);
            put(v, other.v);
            put(load, other.load);
            choose(carried, other.carried);
            put(current, other.current);
            put(second.q, other.second.q);
            put(second.w, other.second.w);
            for (std::size_t i = 0; i < springs; ++i) {
                put(friction.force[i], other.friction.force[i]);
                choose(friction.slips[i], other.friction.slips[i]);
            }
            laws = other.laws;
        }
        static state at(Real position, Real velocity = Real(0)) noexcept {
            state s;
            s.x = s.load = position;
            s.v = velocity;
            return s;
        }
    };
    /// What acts on the axis from outside during a step.
    struct surroundings {
        Real time{0};               ///< at the step's start, from the first row of the log [s]
        Real other_acceleration{0}; ///< of the other axis [m/s^2]
    };

    servo_axis(const parameters& p, Real h) : servo_axis(checked(p, h), h, already_checked()) {}
    servo_axis(const parameters& p, Real h, already_checked)
        : h_(h), half_(Real(0.5) * h), mass_(p.mass), force_constant_(p.force_constant),
          dead_zone_(p.dead_zone), limit_(p.limit), constant_(p.constant), spring_(p.spring),
          gravity_(p.gravity), gravity_phase_(p.gravity_phase), load_friction_(p.load_friction),
          coupling_(p.mass * p.coupling), process_mean_(p.process_mean), process_start_(p.process_start),
          drift_(p.drift), inverse_drift_(Real(1) / p.drift_time), half_play_(Real(0.5) * p.play),
          lag_({p.lag}, h, already_checked()), ripple_(p.ripple), cogging_(p.cogging), process_(p.process),
          along_(p.along), cyclic_(p.cyclic), second_(p.second, h, already_checked()), laws_(p.laws),
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
        Real drive = push + pull;
        if (has_more_force_) {
            if (cogging_.present()) drive += cogging_(x);
            if (process_.present()) drive += process_(time + process_start_);
            if (has_mean_) drive += process_mean_;
            if (has_coupling_) drive += coupling_ * now.other_acceleration;
            if (laws_.at(joint::force)) drive += laws_(joint::force, point(), s.laws);
        }
        Real momentum = inertia_ * s.v + h_ * drive;
        if (second_.present()) momentum -= second_.impulse(s.second);
        const Real before = s.v;
        if (!level_changes_ && !has_load_friction_)
            s.v = friction_(s.friction, momentum, before);
        else if (!has_load_friction_)
            s.v = friction_(s.friction, momentum, before, change_of_level(s, time, point));
        else
            s.v = friction_(s.friction, momentum, before, change_of_level(s, time, point),
                            load_friction_ * abs(push - pull));
        if (second_.present()) second_.advance(s.second, before, s.v);
        s.x += half_ * (before + s.v);
        if (has_transmission_)
            transmit(s, point);
        else
            s.load = s.x;
    }

    /// What the encoder reads of where the load is [m].
    Real reading(const state& s) const noexcept {
        if (!has_reading_error_) return s.load;
        Real y = s.load;
        if (cyclic_.present()) y += cyclic_(s.load);
        if (laws_.at(joint::reading))
            y += laws_(joint::reading, joint_point<Real>{s.load, s.v, Real(0), Real(0), h_}, s.laws);
        return y;
    }
    /// The position that reads so, to the first order of the cyclic error [m].
    Real position_of(Real reading) const noexcept {
        return cyclic_.present() ? reading - cyclic_(reading) : reading;
    }
    /// Velocity of what the encoder sits on: zero while the motor crosses the play [m/s].
    Real load_velocity(const state& s) const noexcept {
        return has_play_ ? select(either(s.carried, equal(half_play_, Real(0))), s.v, Real(0)) : s.v;
    }
    Real mass() const noexcept { return mass_; }

private:
    static const parameters& checked(const parameters& p, Real h) {
        require_positive<Real>("servo_axis.step", h);
        require_positive<Real>("servo_axis.mass", p.mass);
        require_finite<Real>("servo_axis.force_constant", p.force_constant);
        require_not_negative<Real>("servo_axis.dead_zone", p.dead_zone);
        for (std::size_t i = 0; i < lane_count<Real>; ++i) {
            require(lane(p.limit, i) > 0, "servo_axis.limit", lane(p.limit, i), "must be above 0");
            require(detail::plain(lane(p.second.mass, i)) < lane(p.mass, i), "servo_axis.second.mass",
                    lane(p.second.mass, i),
                    "must lie below the mass, of which it is a part (" + detail::shortest(lane(p.mass, i)) +
                        ")");
        }
        require_finite<Real>("servo_axis.constant", p.constant);
        require_finite<Real>("servo_axis.spring", p.spring);
        require_finite<Real>("servo_axis.gravity", p.gravity);
        require_finite<Real>("servo_axis.gravity_phase", p.gravity_phase);
        require_not_negative<Real>("servo_axis.load_friction", p.load_friction);
        require_finite<Real>("servo_axis.coupling", p.coupling);
        const auto repeats = [](const char* name, const repeating& r) {
            require_positive<Real>({name, ".period"}, r.period);
            for (std::size_t i = 0; i < harmonics; ++i) {
                require_finite<Real>({name, ".cosine"}, r.cosine[i]);
                require_finite<Real>({name, ".sine"}, r.sine[i]);
            }
        };
        repeats("servo_axis.ripple", p.ripple);
        repeats("servo_axis.cogging", p.cogging);
        repeats("servo_axis.process", p.process);
        repeats("servo_axis.along", p.along);
        repeats("servo_axis.cyclic", p.cyclic);
        require_finite<Real>("servo_axis.process_mean", p.process_mean);
        require_finite<Real>("servo_axis.process_start", p.process_start);
        require_finite<Real>("servo_axis.drift", p.drift);
        require_positive<Real>("servo_axis.drift_time", p.drift_time);
        require_not_negative<Real>("servo_axis.play", p.play);
        (void)amplifier_lag<Real>({p.lag}, h);
        (void)sprung_mass<Real>(p.second, h);
        (void)contact(p.friction, p.mass, h);
        return p;
    }

    /// A sum over harmonics with its period, up to the last harmonic that has a size in some lane.
    class sum {
    public:
        explicit sum(const repeating& r) : inverse_period_(Real(1) / Real(r.period)) {
            for (std::size_t i = 0; i < harmonics; ++i) {
                series_.cosine[i] = Real(r.cosine[i]);
                series_.sine[i] = Real(r.sine[i]);
            }
            while (series_.count > 0 && all(equal(series_.cosine[series_.count - 1], Real(0))) &&
                   all(equal(series_.sine[series_.count - 1], Real(0))))
                --series_.count;
        }
        bool present() const noexcept { return series_.count > 0; }
        Real operator()(Real z) const noexcept { return series_(z * inverse_period_); }

    private:
        Real inverse_period_;
        detail::harmonic_series<harmonics, Real, Real> series_;
    };

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
    sum ripple_, cogging_, process_, along_, cyclic_;
    sprung_mass<Real> second_;
    Laws laws_;
    Real inertia_;
    contact friction_;
    bool has_dead_zone_ = false, has_limit_ = false, has_spring_ = false, has_gravity_ = false,
         has_load_friction_ = false, has_coupling_ = false, has_drift_ = false, has_play_ = false,
         has_mean_ = false, level_changes_ = false;
    bool has_shaper_ = false, has_ripple_ = false, has_more_force_ = false, has_transmission_ = false,
         has_reading_error_ = false; ///< whether any of what may sit at this joint is there
};

} // namespace quadrant::inline v0
