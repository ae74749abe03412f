// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../observer/nominal_plant.hpp"
#include "axis_law.hpp"
#include "proportional_integral.hpp"

#include <complex>
#include <limits>
#include <numbers>

namespace quadrant::inline v0 {

/// A control law of a feed drive that keeps it on a sliding surface, S = 0, on which the error dies out with
/// sliding: the inverse of the plant, a gain on S, and an estimate of the disturbance that adapts until the
/// error is gone.
///   S = sliding (x_ref - x) + (v_ref - v)
///   u = {sliding (v_ref - v) + a_ref + A v} / B + Ks S + d,   d = rho {(x_ref - x) + sliding T sum (x_ref - x)}
/// A and B of x/u = B / (s (s + A)); 1/B is Je, A/B is Be of the source. No switching, so no chattering.
/// Around an exact plant the error obeys S' + B Ks S + B rho (integral of S) = B disturbance (in units of the
/// command).
/// Source: [Yeung2006] eqs. (20, 21); [Altintas2000].
/// Ports: those of `axis_law`. The sum has the present sample in it.
/// State: d, as the integral of a `proportional_integral`; `reset` at rest at zero; `settle(x, u)`: d holds u.
/// `retune(next, reference, x, v, u)`: as `retunable_law` says; d takes what the new gains change. Then
/// |u'[k] - u| <= what the new law without d makes of the change of its inputs, + rho' |e[k] - e[k-1]| +
/// lambda' rho' T |e[k]| + what d has beyond its new limit (+ T/tracking_time' times the excess), e = x_ref -
/// x.
/// Range: B > 0, A >= 0, sliding > 0 in 1/s (not hertz), Ks >= 0, rho >= 0. limit is that of the amplifier, for
/// d; report what was applied with applied(u). Friction that the reference will cause is
/// best fed forward beside the law (`feed_control`).
/// NaN and infinities: holds the last command, keeps the state, raises faulted().
/// Throws "sliding_mode.<field> = ...: must ..." for plant, sliding, gain, adaptation; limit as
/// `proportional_integral`.
/// Cost: 7 multiplications. Without a model: `pid`.
template <class Real = double, signal_tag Command = signal::voltage,
          anti_windup_rule AntiWindup = conditional_integration>
class sliding_mode {
    using adaptation_box = proportional_integral<signal::position, Command, AntiWindup, Real>;

public:
    using output = Command;
    using value = quantity_of<Command, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The axis as believed, how fast its error dies out, gain and adaptation, and the limit that the estimate
    /// has to know of.
    struct parameters {
        axis_model<Command, number> plant;                     ///< as the law believes it
        quantity<si::frequency, number> sliding;               ///< lambda, in 1/s; > 0
        gain_of<Command, signal::velocity, number> gain;       ///< Ks; >= 0
        gain_of<Command, signal::position, number> adaptation; ///< rho; >= 0
        quantity_of<Command, number> limit =
            quantity_of<Command, number>::from_value(number(std::numeric_limits<double>::infinity())); ///< > 0
        AntiWindup anti_windup = {};
    };
    /// How far the axis was off the surface, and what push was taken for its cause.
    struct state {
        velocity s{};        ///< S of the last sample
        value disturbance{}; ///< d of the last sample
    };

    sliding_mode(const parameters& p, duration period)
        : given_(checked(p, period)), period_(period),
          adaptation_({p.adaptation, p.sliding * p.adaptation, p.limit, p.anti_windup}, period),
          sliding_(in_real<Real>(p.sliding)), gain_(in_real<Real>(p.gain)) {
        inertia_ = in_real<Real>(gain_of<Command, signal::acceleration, number>(number(1) / p.plant.gain));
        drag_ = in_real<Real>(gain_of<Command, signal::velocity, number>(p.plant.viscous_rate / p.plant.gain));
    }

    value operator()(const axis_motion<Real>& reference, position measured, velocity tachometer) noexcept {
        const position error = reference.position - measured;
        const velocity s = sliding_ * error + (reference.velocity - tachometer);
        const value rest = without_estimate(reference, tachometer, s);
        if (!finite(error, rest)) return out_.hold();
        const value d = adaptation_(error);
        if (!finite(rest + d)) return out_.hold();
        state_ = {s, d};
        return out_.keep(rest + d);
    }
    /// What was applied of the last command.
    void applied(value u) noexcept { adaptation_.applied(state_.disturbance + (u - out_.last())); }
    void reset() noexcept {
        adaptation_.reset();
        state_ = {};
        out_.reset();
    }
    void settle(position x, value u) noexcept {
        if (!finite(x, u)) return out_.raise();
        adaptation_.settle(position(), u);
        state_ = {velocity(), u};
        out_.reset(u);
    }

    void retune(const sliding_mode& next, const axis_motion<Real>& reference, position measured,
                velocity tachometer, value u) noexcept {
        const position error = reference.position - measured;
        const velocity s = next.sliding_ * error + (reference.velocity - tachometer);
        const value disturbance = u - next.without_estimate(reference, tachometer, s);
        if (next.period_ != period_ || !finite(error, disturbance)) return out_.raise();
        const auto kept = state_;
        const auto out = out_;
        auto adaptation = adaptation_;
        adaptation.retune(next.adaptation_, error, disturbance);
        *this = next;
        state_ = kept;
        out_ = out;
        adaptation_ = adaptation;
    }

    /// Of the unlimited law.
    law_response response(frequency f) const {
        const double sliding = detail::plain(sliding_), gain = detail::plain(gain_),
                     inertia = detail::plain(inertia_), drag = detail::plain(drag_);
        law_response y;
        y.to_position = y.from_position = adaptation_.response(f) + gain * sliding;
        y.to_velocity = inertia * sliding + gain;
        y.from_velocity = inertia * sliding + gain - drag;
        y.to_acceleration = inertia;
        return y;
    }
    bool limited() const noexcept { return adaptation_.limited(); } ///< the adaptation was restrained
    bool faulted() const noexcept { return out_.faulted() || adaptation_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("sliding_mode.period", period);
        require_positive<Real>("sliding_mode.plant.gain", p.plant.gain);
        require_not_negative<Real>("sliding_mode.plant.viscous_rate", p.plant.viscous_rate);
        require_positive<Real>("sliding_mode.sliding", p.sliding);
        require_not_negative<Real>("sliding_mode.gain", p.gain);
        require_not_negative<Real>("sliding_mode.adaptation", p.adaptation);
        return p;
    }

    value without_estimate(const axis_motion<Real>& reference, velocity tachometer, velocity s) const noexcept {
        return inertia_ * (sliding_ * (reference.velocity - tachometer) + reference.acceleration) +
               drag_ * tachometer + gain_ * s;
    }

    parameters given_;
    duration period_;
    adaptation_box adaptation_;
    quantity<si::frequency, Real> sliding_;
    gain_of<Command, signal::velocity, Real> gain_;
    gain_of<Command, signal::acceleration, Real> inertia_; ///< Je
    gain_of<Command, signal::velocity, Real> drag_;        ///< Be
    state state_;
    held_output<value> out_;
};
static_assert(retunable_law<sliding_mode<>>);

/// How the way to the surface shall look: the integral of S as a mass on spring and damper.
struct sliding_dynamics {
    quantity<si::frequency> sliding; ///< lambda, in 1/s (not hertz); > 0
    frequency natural;               ///< of the way to the surface, in hertz; > 0
    double damping = 0.7;            ///< > 0
};

/// Ks = 2 damping w / B and rho = w^2 / B, w = 2 pi natural: S'' + 2 damping w S' + w^2 S = B disturbance'.
template <signal_tag Command>
auto design_sliding_mode(const axis_model<Command>& plant, const sliding_dynamics& wanted) {
    require_positive("design_sliding_mode.plant.gain", plant.gain);
    require_positive("design_sliding_mode.sliding", wanted.sliding);
    require_positive("design_sliding_mode.natural", wanted.natural);
    require_positive("design_sliding_mode.damping", wanted.damping);
    const double w = 2 * std::numbers::pi * wanted.natural.value();
    typename sliding_mode<double, Command>::parameters p;
    p.plant = plant;
    p.sliding = wanted.sliding;
    p.gain = decltype(p.gain)::from_value(2 * wanted.damping * w / plant.gain.value());
    p.adaptation = decltype(p.adaptation)::from_value(w * w / plant.gain.value());
    return p;
}

} // namespace quadrant::inline v0
