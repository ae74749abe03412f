// SPDX-License-Identifier: BSL-1.0
// Long: one block: its step by one spring and by several, and what every block has.
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "already_checked.hpp"
#include "spring_law.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace quadrant::inline v0 {

/// The friction of a guide as a plant takes it: Maxwell-slip with a level of its own in each direction, solved
/// together with the mass that it brakes.
///   M (v' - v)/h = drive - viscous v' - sum F_i',   F_i as in `maxwell_slip` with the level s(v) of the step's start,
///   s(v) = level (1 + asymmetry sign v) (1 + change) + added + excess (1 + excess_asymmetry sign v) exp(-(|v|/vs(sign v))^shape)
/// `added`, a level that a load presses onto the contact, also stiffens each spring by weight_i added / give_i.
/// A spring that sticks also resists with stiffness_i damping v (LuGre's sigma_1). Which springs stick is found
/// in at most 2 N + 1 rounds, one in nearly all steps: the sum of their forces rises with the velocity.
/// Velocity and spring forces are implicit, so no step adds energy and a stiff contact neither rings nor needs
/// a small h; the level is that of the start.
/// Source: [AlBender2005]; [Jamaludin2008] eqs. (3.6-3.8). Derivation: docs/derivations/maxwell_slip.md.
/// Ports: the momentum p = M v + h (all other forces) [N s], velocity v, change (relative, of the level) and
/// added >= 0 [N] in, v' out.
/// State: per spring its force [N] and whether it slips; given and returned by the caller, who may step many
/// contacts by one law.
/// Range: level, excess >= 0; 0.25 <= shape <= 4; stiffness >= 0; attraction > 0, infinity: a spring that slips
/// holds its share at once. A spring with the weight 0 and the stiffness 0 is not there.
/// NaN and infinities pass on to v', for the plant to see. Runs in lanes.
/// Throws "slip_contact.<field> = ...: must ...".
/// Cost: 1 exponential (2 with a finite attraction; 1 and a logarithm more where shape is not 1), about 12
/// multiplications and, for N > 1, one division a round.
template <std::size_t N, class Real = double>
requires(N > 0) class slip_contact {
public:
    using number = parameter_real<Real>; ///< of parameters
    template <class Signal> using of = quantity_of<Signal, number>;

    /// The level, what it depends on, and the springs.
    struct parameters {
        of<signal::force> level{};  ///< Fc, at speed; >= 0
        of<signal::force> excess{}; ///< Fs - Fc; >= 0
        of<signal::velocity> stribeck_velocity = of<signal::velocity>::from_value(number(1)); ///< vs; > 0
        number shape{1};                                            ///< of |v|/vs; 0.25 ... 4
        gain_of<signal::force, signal::velocity, number> viscous{}; ///< >= 0
        number asymmetry{0};                                        ///< of the level; -1 ... 1
        number excess_asymmetry{0};                                 ///< of the excess; -1 ... 1
        number velocity_asymmetry{0};                               ///< of vs; above -1, below 1
        number viscous_asymmetry{0};                                ///< -1 ... 1
        std::array<number, N> weights{};                            ///< shares of the level
        std::array<gain_of<signal::force, signal::position, number>, N> stiffness{}; ///< >= 0
        std::array<of<signal::position>, N>
            give{}; ///< displacement at which a spring holds its share of an added level;
                    ///< >= 0; 0: the stiffness stays
        quantity<unit_quotient<si::force, si::time>, number> attraction =
            quantity<unit_quotient<si::force, si::time>, number>::from_value(
                number(std::numeric_limits<double>::infinity())); ///< C; > 0
        quantity<si::time, number> damping{};                     ///< of a spring that sticks; >= 0
    };
    /// What the springs hold [N], and which of them slip.
    struct state {
        std::array<Real, N> force{};
        std::array<mask_of<Real>, N> slips{};
    };

    /// `inertia`: what the momentum is of, a rigid mass or one with a mode on it [kg]; h: the step [s].
    slip_contact(const parameters& p, Real inertia, Real h)
        : slip_contact(checked(p), inertia, h, already_checked()) {}
    slip_contact(const parameters& p, Real inertia, Real h, already_checked)
        : h_(h), damping_(in_real<Real>(p.damping).value()) {
        const Real attraction = in_real<Real>(p.attraction).value();
        relaxes_ = any(less(attraction, Real(std::numeric_limits<double>::infinity())));
        attraction_step_ = attraction * h;
        shape_ = Real(p.shape);
        shaped_ = any(!equal(shape_, Real(1)));
        for (std::size_t i = 0; i < N; ++i) {
            weight_[i] = Real(p.weights[i]);
            stiffness_[i] = in_real<Real>(p.stiffness[i]).value();
            const Real give = in_real<Real>(p.give[i]).value();
            const auto gives = greater(give, Real(0));
            stiffening_[i] = select(gives, weight_[i] / select(gives, give, Real(1)), Real(0));
            if (any(greater(weight_[i], Real(0))) || any(greater(stiffness_[i], Real(0)))) springs_ = i + 1;
        }
        for (const bool forward : {false, true}) {
            side& s = forward ? forward_ : backward_;
            const Real sign = Real(forward ? 1 : -1);
            s.level = in_real<Real>(p.level).value() * (Real(1) + Real(p.asymmetry) * sign);
            s.excess = in_real<Real>(p.excess).value() * (Real(1) + Real(p.excess_asymmetry) * sign);
            s.inverse_velocity = Real(1) / (in_real<Real>(p.stribeck_velocity).value() *
                                            (Real(1) + Real(p.velocity_asymmetry) * sign));
            falls_ = falls_ || any(greater(s.excess, Real(0)));
            falls_by_side_ = falls_by_side_ || any(!equal(Real(p.excess_asymmetry), Real(0))) ||
                             any(!equal(Real(p.velocity_asymmetry), Real(0)));
            s.inertia =
                inertia + h * in_real<Real>(p.viscous).value() * (Real(1) + Real(p.viscous_asymmetry) * sign);
            s.slipping = Real(1) / s.inertia;
            s.sticking = Real(1) / (s.inertia + h * (h + damping_) * stiffness_[0]);
        }
    }

    /// The velocity at the end of the step.
    [[gnu::always_inline]] inline Real operator()(state& s, Real momentum, Real v) const noexcept {
        return step(
            s, momentum, v, [](const Real& level) { return level; }, none_added());
    }
    Real operator()(state& s, Real momentum, Real v, Real change) const noexcept {
        return step(
            s, momentum, v, [&](const Real& level) { return level * (Real(1) + change); }, none_added());
    }
    Real operator()(state& s, Real momentum, Real v, Real change, Real added) const noexcept {
        return step(
            s, momentum, v, [&](const Real& level) { return level * (Real(1) + change) + added; }, added);
    }

    /// The friction's level at a velocity, or where it is zero as a force `pushes` from rest [N].
    Real level_at(Real v, Real pushes, Real change = Real(0), Real added = Real(0)) const noexcept {
        const auto forward = greater(select(equal(v, Real(0)), pushes, v), Real(0));
        const Real level = select(forward, forward_.level, backward_.level) * (Real(1) + change) + added;
        return falls_ ? level + excess_at(forward, v) : level;
    }

private:
    struct side { // of one direction of motion
        Real level{}, excess{}, inverse_velocity{}, inertia{};
        Real slipping{}, sticking{}; ///< one over the inertia while the first spring slips, and while it sticks
    };
    struct none_added {};
    using law = detail::spring_law<Real, Real>;
    static Real along(const auto& positive, Real force) noexcept { return select(positive, force, -force); }

    static const parameters& checked(const parameters& p) {
        require_not_negative<Real>("slip_contact.level", p.level);
        require_not_negative<Real>("slip_contact.excess", p.excess);
        require_positive<Real>("slip_contact.stribeck_velocity", p.stribeck_velocity);
        require_not_negative<Real>("slip_contact.viscous", p.viscous);
        require_not_negative<Real>("slip_contact.damping", p.damping);
        for (std::size_t i = 0; i < lane_count<Real>; ++i) {
            const double c = detail::plain(lane(p.attraction, i));
            require(c > 0, "slip_contact.attraction", c, "must be above 0");
            const auto side = [i](const detail::field_name& field, const number& of) {
                const double a = detail::plain(lane(of, i));
                require(std::abs(a) <= 1, field, a, "must lie between -1 and 1");
            };
            side("slip_contact.asymmetry", p.asymmetry);
            side("slip_contact.excess_asymmetry", p.excess_asymmetry);
            side("slip_contact.viscous_asymmetry", p.viscous_asymmetry);
            const double shape = detail::plain(lane(p.shape, i));
            require(shape >= 0.25 && shape <= 4, "slip_contact.shape", shape, "must lie between 0.25 and 4");
            const double v = detail::plain(lane(p.velocity_asymmetry, i));
            require(std::abs(v) < 1, "slip_contact.velocity_asymmetry", v,
                    "must lie between -1 and 1, both excluded");
        }
        for (std::size_t i = 0; i < N; ++i) {
            require_not_negative<Real>("slip_contact.weights", p.weights[i]);
            require_not_negative<Real>("slip_contact.stiffness", p.stiffness[i]);
            require_not_negative<Real>("slip_contact.give", p.give[i]);
        }
        return p;
    }
    Real stiffness(std::size_t i, none_added) const noexcept { return stiffness_[i]; }
    Real stiffness(std::size_t i, const Real& added) const noexcept {
        return stiffness_[i] + added * stiffening_[i];
    }
    /// One over the inertia of one side while the first spring sticks.
    Real sticking(const auto& forward, none_added) const noexcept {
        return select(forward, forward_.sticking, backward_.sticking);
    }
    Real sticking(const auto& forward, const Real& added) const noexcept {
        return Real(1) / (select(forward, forward_.inertia, backward_.inertia) +
                          h_ * (h_ + damping_) * stiffness(0, added));
    }
    [[gnu::always_inline]] inline Real step(state& s, const Real& momentum, const Real& v, const auto& changed,
                                            const auto& added) const noexcept {
        const auto forward = greater(select(equal(v, Real(0)), momentum, v), Real(0));
        Real level = changed(select(forward, forward_.level, backward_.level));
        if (falls_) level = level + excess_at(forward, v);
        Real kept(0);
        if (relaxes_) { // a level of zero has no distance to keep
            const Real by = attraction_step_ / select(greater(level, Real(0)), level, Real(1));
            kept = decayed(select(less(by, Real(700)), by, Real(700)));
        }
        if (springs_ == 1) return one(s, momentum, level, kept, forward, added);
        const Real inertia = select(forward, forward_.inertia, backward_.inertia);
        return springs_ == N
                   ? several(s, momentum, level, kept, inertia, added, std::integral_constant<std::size_t, N>())
                   : several(s, momentum, level, kept, inertia, added, springs_);
    }
    /// What the level has more at low speed.
    [[gnu::always_inline]] inline Real excess_at(const auto& forward, const Real& v) const noexcept {
        using std::abs;
        Real excess = forward_.excess, inverse = forward_.inverse_velocity;
        if (falls_by_side_) {
            excess = select(forward, excess, backward_.excess);
            inverse = select(forward, inverse, backward_.inverse_velocity);
        }
        Real slowness = abs(v) * inverse;
        if (shaped_) { // nearly no speed has a logarithm too
            using std::exp, std::log;
            const auto moves = greater(slowness, Real(1e-18));
            slowness = select(moves, exp(shape_ * log(select(moves, slowness, Real(1)))), Real(0));
        }
        return excess * decayed(slowness);
    }

    /// A contact of one spring, which most guides are: all three ways, and the one that is true.
    [[gnu::always_inline]] inline Real one(state& s, const Real& momentum, const Real& level, const Real& kept,
                                           const auto& forward, const auto& added) const noexcept {
        using std::abs;
        const law spring{weight_[0] * level, kept};
        const Real slipping = select(forward, forward_.slipping, backward_.slipping),
                   braked = sticking(forward, added);
        Real& force = s.force[0];
        const auto bent = greater_equal(force, Real(0));
        const Real on = along(bent, relaxes_ ? spring.slips_on(abs(force)) : spring.share);
        const Real v_on = (momentum - h_ * on) * slipping;
        const auto slips_on = both(s.slips[0], greater(v_on * force, Real(0)));

        const Real v_stuck = (momentum - h_ * force) * braked;
        const Real reached = force + h_ * stiffness(0, added) * v_stuck;
        const auto ahead = greater(v_stuck, Real(0));
        const auto rests =
            both(!slips_on, either(spring.sticks(along(ahead, reached)), equal(v_stuck, Real(0))));
        const Real away = along(ahead, relaxes_ ? spring.breaks_away(along(ahead, force)) : spring.share);
        const Real v_away = (momentum - h_ * away) * slipping;

        force = select(slips_on, on, select(rests, reached, away));
        s.slips[0] = !rests;
        return select(slips_on, v_on, select(rests, v_stuck, v_away));
    }

    /// Several springs: who slips is assumed, the velocity solved, and the assumption corrected where it was
    /// wrong. `count`: how many there are, a constant where all are.
    [[gnu::noinline]] Real several(state& s, const Real& momentum, const Real& level, const Real& kept,
                                   const Real& inertia, const auto& added, const auto count) const noexcept {
        using std::abs;
        std::array<Real, N> share{}, end{}, stiff{};   // end: force of the springs that slip, at the end
        std::array<mask_of<Real>, N> slips{}, fresh{}; // fresh: broke away in this step
        for (std::size_t i = 0; i < count; ++i) {
            share[i] = weight_[i] * level;
            stiff[i] = stiffness(i, added);
            slips[i] = s.slips[i];
            end[i] = along(greater_equal(s.force[i], Real(0)),
                           relaxes_ ? law{share[i], kept}.slips_on(abs(s.force[i])) : share[i]);
        }
        Real v(0);
        for (std::size_t round = 0; round <= 2 * count; ++round) {
            Real pull(0), stuck(0);
            for (std::size_t i = 0; i < count; ++i) {
                pull = pull + select(slips[i], end[i], s.force[i]);
                stuck = stuck + select(slips[i], Real(0), stiff[i]);
            }
            v = (momentum - h_ * pull) / (inertia + h_ * (h_ + damping_) * stuck);
            const auto ahead = greater(v, Real(0)), moves = !equal(v, Real(0));
            const Real speed = abs(v);
            auto changed = !equal(v, v); // none, but for NaN
            std::array<mask_of<Real>, N> turned{}, breaks{};
            for (std::size_t i = 0; i < count; ++i) {
                turned[i] = both(both(slips[i], !fresh[i]), less_equal(end[i] * v, Real(0)));
                breaks[i] = both(both(!slips[i], moves),
                                 !law{share[i], kept}.sticks(along(ahead, s.force[i]) + h_ * stiff[i] * speed));
                changed = either(changed, either(turned[i], breaks[i]));
            }
            if (none(changed)) break; // nearly always in the first round
            for (std::size_t i = 0; i < count; ++i) {
                const Real away = law{share[i], kept}.breaks_away(along(ahead, s.force[i]));
                end[i] = select(breaks[i], along(ahead, away), end[i]);
                fresh[i] = either(fresh[i], breaks[i]);
                slips[i] = either(both(slips[i], !turned[i]), breaks[i]);
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            s.force[i] = select(slips[i], end[i], s.force[i] + h_ * stiff[i] * v);
            s.slips[i] = slips[i];
        }
        return v;
    }

    Real h_, damping_, attraction_step_{}, shape_{};
    bool relaxes_ = false, falls_ = false, falls_by_side_ = false,
         shaped_ =
             false; ///< a finite attraction; a level that falls with the speed, and otherwise than shape 1
    std::size_t springs_ = 1;
    std::array<Real, N> weight_{}, stiffness_{}, stiffening_{};
    side forward_, backward_;
};

} // namespace quadrant::inline v0
