// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../filter/viscous_step.hpp"
#include "../observer/matrix.hpp"
#include "../observer/nominal_plant.hpp"
#include "axis_law.hpp"
#include "proportional.hpp"
#include "proportional_integral.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <numbers>

namespace quadrant::inline v0 {

/// A control law of a feed drive as most drives have it: a position loop (P) asks a velocity loop (PI) for a
/// speed.
///   e = Kv (x_ref - x) + c v_ref - v,   u = Kp e + Ki T sum e + Ka a_ref
/// Source: [Ellis2012] (P/PI cascade with velocity and acceleration feedforward).
/// Ports: those of `axis_law`; the velocity loop is closed over the tachometer. The sum has the present sample
/// in it.
/// State: the integral of the velocity loop in units of the command; `reset` at rest at zero; `settle(x, u)`:
/// it holds u.
/// `retune(next, reference, x, v, u)`: as `retunable_law` says; the integral takes what the new gains change.
/// Then |u'[k] - u| <= Kp' |e'[k] - e'[k-1]| + Ki' T |e'[k]| + |Ka'| |a_ref[k] - a_ref[k-1]| + what the
/// integral has beyond its new limit (+ T/tracking_time' times the excess), e' with the new gains.
/// Range: Kv any finite, Kp and Ki >= 0, c and Ka finite (c = 0: follows late by 1/Kv). limit is that of the
/// amplifier, for the integral; report what was applied with applied(u).
/// NaN and infinities: holds the last command, keeps the state, raises faulted().
/// Throws "p_pi.velocity_weight = ...: must be finite", "p_pi.acceleration_gain = ...: ..."; the others as the
/// boxes.
/// Cost: 5 multiplications. On positions alone: `pid`; as a whole diagram with filters: `cascade`.
template <class Real = double, signal_tag Command = signal::voltage,
          anti_windup_rule AntiWindup = conditional_integration>
class p_pi {
    using position_box = proportional<signal::position, signal::velocity, Real>;
    using velocity_box = proportional_integral<signal::velocity, Command, AntiWindup, Real>;

public:
    using output = Command;
    using value = quantity_of<Command, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// Gains of both loops, what is fed forward, and the limit that the integral has to know of.
    struct parameters {
        gain_of<signal::velocity, signal::position, number> position_gain;  ///< Kv, in 1/s; finite
        gain_of<Command, signal::velocity, number> gain;                    ///< Kp; >= 0
        gain_rate_of<Command, signal::velocity, number> integral_gain;      ///< Ki; >= 0
        number velocity_weight = 1;                                         ///< c
        gain_of<Command, signal::acceleration, number> acceleration_gain{}; ///< Ka; of the axis: 1/B
        quantity_of<Command, number> limit =
            quantity_of<Command, number>::from_value(number(std::numeric_limits<double>::infinity())); ///< > 0
        AntiWindup anti_windup = {};
    };
    /// What the cascade holds beside its integral: the last error [m/s] and the last command of the velocity
    /// loop.
    struct state {
        velocity error{}; ///< of the velocity loop, at the last sample
        value loop{};     ///< what the velocity loop gave
    };

    p_pi(const parameters& p, duration period)
        : given_(p), period_(period), position_loop_({p.position_gain}, period),
          velocity_loop_({p.gain, p.integral_gain, p.limit, p.anti_windup}, period),
          weight_(Real(p.velocity_weight)), acceleration_gain_(in_real<Real>(p.acceleration_gain)) {
        require_finite<Real>("p_pi.velocity_weight", p.velocity_weight);
        require_finite<Real>("p_pi.acceleration_gain", p.acceleration_gain);
    }

    value operator()(const axis_motion<Real>& reference, position measured, velocity tachometer) noexcept {
        const position off = reference.position - measured;
        const velocity ahead = weight_ * reference.velocity - tachometer;
        const value inertia = acceleration_gain_ * reference.acceleration;
        const auto good = finite(off, ahead, inertia, position_gain() * off);
        if (none(good)) return out_.hold();
        const velocity error = position_loop_(only_where(good, off)) + ahead;
        const value loop = velocity_loop_(only_where(good, error));
        const auto sound = both(good, finite(error, loop + inertia));
        if (none(sound)) return out_.hold();
        set_where(sound, state_.error, error);
        set_where(sound, state_.loop, loop);
        return out_.keep(sound, loop + inertia);
    }
    /// What was applied of the last command.
    void applied(value u) noexcept { velocity_loop_.applied(state_.loop + (u - out_.last())); }
    void reset() noexcept {
        position_loop_.reset();
        velocity_loop_.reset();
        state_ = {};
        out_.reset();
    }
    void settle(position x, value u) noexcept {
        const auto good = finite(x, u);
        if (none(good)) return out_.raise();
        position_loop_.settle(only_where(good, position()));
        velocity_loop_.settle(velocity(), only_where(good, u));
        set_where(good, state_.error, velocity());
        set_where(good, state_.loop, u);
        out_.settle(good, u);
    }

    void retune(const p_pi& next, const axis_motion<Real>& reference, position measured, velocity tachometer,
                value u) noexcept {
        const velocity error = next.position_gain() * (reference.position - measured) +
                               (next.weight_ * reference.velocity - tachometer);
        const value loop = u - next.acceleration_gain_ * reference.acceleration;
        const auto good = finite(error, loop);
        if (next.period_ != period_ || none(good)) return out_.raise();
        position_loop_.retune(next.position_loop_);
        velocity_loop_.retune(next.velocity_loop_, only_where(good, error), only_where(good, loop));
        given_ = next.given_;
        weight_ = next.weight_;
        acceleration_gain_ = next.acceleration_gain_;
        out_.raise(!good);
    }

    /// Of the unlimited law.
    law_response response(frequency f) const {
        law_response y;
        y.from_velocity = velocity_loop_.response(f);
        y.to_position = y.from_position = position_loop_.response(f) * y.from_velocity;
        y.to_velocity = detail::plain(weight_) * y.from_velocity;
        y.to_acceleration = detail::plain(acceleration_gain_);
        return y;
    }
    bool limited() const noexcept { return velocity_loop_.limited(); } ///< the integral was restrained
    bool faulted() const noexcept {
        return out_.faulted() || position_loop_.faulted() || velocity_loop_.faulted();
    }
    mask_of<Real> faulted_lanes() const noexcept {
        return either(out_.faulted_lanes(),
                      either(position_loop_.faulted_lanes(), velocity_loop_.faulted_lanes()));
    }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    gain_of<signal::velocity, signal::position, Real> position_gain() const noexcept {
        return in_real<Real>(given_.position_gain);
    }

    parameters given_;
    duration period_;
    position_box position_loop_;
    velocity_box velocity_loop_;
    Real weight_;
    gain_of<Command, signal::acceleration, Real> acceleration_gain_;
    state state_;
    held_output<value> out_;
};
static_assert(retunable_law<p_pi<>>);

/// How fast the loops of a `p_pi` shall be: the velocity loop first, the position loop a share of it.
struct p_pi_loops {
    frequency natural;      ///< of the velocity loop; > 0
    double damping = 1;     ///< of it; > 0
    double position = 0.25; ///< Kv, as a share of w = 2 pi natural; > 0
};

/// Kp = (2 damping w - A)/B, Ki = w^2/B, Kv = position w, Ka = 1/B on x/u = B / (s (s + A)); the sampled loop
/// is checked.
/// Source: [Ellis2012]. In continuous time: keep w below a twentieth of the sampling rate in rad/s.
/// Throws "place_p_pi.<field> = ...: must ..."; a sampled loop that is not stable is refused.
template <signal_tag Command>
auto place_p_pi(const axis_model<Command>& plant, const p_pi_loops& wanted, duration period) {
    require_positive("place_p_pi.plant.gain", plant.gain);
    require_not_negative("place_p_pi.plant.viscous_rate", plant.viscous_rate);
    require_positive("place_p_pi.natural", wanted.natural);
    require_positive("place_p_pi.damping", wanted.damping);
    require_positive("place_p_pi.position", wanted.position);
    require_positive("place_p_pi.period", period);
    const double w = 2 * std::numbers::pi * wanted.natural.value(), B = plant.gain.value(),
                 A = plant.viscous_rate.value(), T = period.value();
    typename p_pi<double, Command>::parameters p;
    p.position_gain = decltype(p.position_gain)::from_value(wanted.position * w);
    p.gain = decltype(p.gain)::from_value((2 * wanted.damping * w - A) / B);
    p.integral_gain = decltype(p.integral_gain)::from_value(w * w / B);
    p.acceleration_gain = decltype(p.acceleration_gain)::from_value(1 / B);
    // The sampled loop in x, v, integral: e = -Kv x - v, I' = I + Ki T e, u = Kp e + I'.
    const viscous_step<> step(A, T);
    const double more = p.integral_gain.value() * T, both = p.gain.value() + more, kv = wanted.position * w;
    const column<3> e{-kv, -1, 0};
    matrix<3> loop{{{1, step.gained, 0}, {0, step.kept, 0}, {0, 0, 1}}};
    for (std::size_t i = 0; i < 3; ++i) {
        const double u = both * e[i] + (i == 2 ? 1 : 0);
        loop[0][i] += B * step.way * u, loop[1][i] += B * step.gained * u, loop[2][i] += more * e[i];
    }
    const double radius = spectral_radius(loop);
    require(radius < 1, "place_p_pi.natural", radius, "must leave the sampled loop stable (largest pole)");
    return p;
}

} // namespace quadrant::inline v0
