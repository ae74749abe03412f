// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "../observer/nominal_plant.hpp"
#include "axis_law.hpp"
#include "proportional_integral.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace quadrant::inline v0 {

/// Where a `pid` takes the velocity error of its derivative part from.
enum class derivative_from {
    tachometer, ///< velocity of the trajectory minus that of the tachometer
    positions   ///< the difference of reference and measured position from sample to sample
};

/// A control law of a feed drive: P and I on the position error, D on the velocity error, each reference with
/// its weight.
///   u = Kp (b x_ref - x) + Ki T sum (x_ref - x) + Kd q,   q = lowpass(c v_ref - v)
/// Source: [Yeung2006] Table 10 (derivative on the velocity error from the tachometer); weights and filter
/// [Astrom1995] ch. 3.4.
/// Ports: those of `axis_law`. The sum includes the present sample. The acceleration of the reference is not
/// used.
/// State: the integral in units of the command, q, the last difference of positions; `reset` at rest at zero;
/// `settle(x, u)`: the integral holds u.
/// `retune(next, reference, x, v, u)`: as `retunable_law` says; the integral takes what the new gains change,
/// q stays. Then |u'[k] - u| <= Kp' |e[k] - e[k-1]| + Ki' T |e[k]| + Kp' |b' - 1| |x_ref[k] - x_ref[k-1]| +
/// Kd' |q[k] - q[k-1]| + what the integral has beyond its new limit (+ T/tracking_time' times the excess).
/// Range: gains >= 0, weights finite (b = c = 0: derivative and proportion on the measurement alone),
/// derivative_corner > 0,
/// infinite: no filter. limit is that of the amplifier, for the integral; report what was applied with
/// applied(u).
/// NaN and infinities: holds the last command, keeps the state, raises faulted().
/// Throws "pid.<field> = ...: must ..." for derivative_gain, weights, derivative_corner; the others as
/// `proportional_integral`.
/// Cost: 6 multiplications. Without derivative: `proportional_integral`; with the inverse of the plant:
/// `sliding_mode`.
template <class Real = double, signal_tag Command = signal::voltage,
          anti_windup_rule AntiWindup = conditional_integration>
class pid {
    using loop_box = proportional_integral<signal::position, Command, AntiWindup, Real>;

public:
    using output = Command;
    using value = quantity_of<Command, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// Gains, the filter of the derivative part, weights of the reference, and the limit that the integral has
    /// to know of.
    struct parameters {
        gain_of<Command, signal::position, number> gain;               ///< Kp; >= 0
        gain_rate_of<Command, signal::position, number> integral_gain; ///< Ki; >= 0
        gain_of<Command, signal::velocity, number> derivative_gain;    ///< Kd; >= 0
        derivative_from derivative = derivative_from::tachometer;
        frequency derivative_corner = frequency::from_value(std::numeric_limits<double>::infinity());
        number position_weight = 1; ///< b
        number velocity_weight = 1; ///< c
        quantity_of<Command, number> limit =
            quantity_of<Command, number>::from_value(number(std::numeric_limits<double>::infinity())); ///< > 0
        AntiWindup anti_windup = {};
    };
    /// The derivative part, what it was made from, and the last command of P and I.
    struct state {
        velocity q{};
        position past{}; ///< c x_ref - x of the last sample
        value loop{};    ///< P and I of the last sample
    };

    pid(const parameters& p, duration period)
        : given_(p), period_(period), loop_({p.gain, p.integral_gain, p.limit, p.anti_windup}, period),
          derivative_gain_(in_real<Real>(p.derivative_gain)), weight_(Real(p.velocity_weight)) {
        require_not_negative<Real>("pid.derivative_gain", p.derivative_gain);
        require_finite<Real>("pid.position_weight", p.position_weight);
        require_finite<Real>("pid.velocity_weight", p.velocity_weight);
        require(p.derivative_corner > frequency(), "pid.derivative_corner", p.derivative_corner,
                "must be above 0 (infinite: no filter)");
        set_aside_ =
            in_real<Real>(gain_of<Command, signal::position, number>(p.gain * (p.position_weight - number(1))));
        require_coefficients<Real>("pid.position_weight", p.position_weight,
                                   (p.gain * (p.position_weight - number(1))).value());
        share_ = 1 - std::exp(-2 * std::numbers::pi * p.derivative_corner.value() * period.value());
    }

    value operator()(const axis_motion<Real>& reference, position measured, velocity tachometer) noexcept {
        const position past = weight_ * reference.position - measured;
        const velocity error = given_.derivative == derivative_from::tachometer
                                   ? velocity(weight_ * reference.velocity - tachometer)
                                   : velocity((past - state_.past) / time());
        const velocity q = state_.q + Real(share_) * (error - state_.q);
        const value rest = set_aside_ * reference.position + derivative_gain_ * q;
        const auto good = finite(reference.acceleration, reference.velocity, tachometer, past, rest);
        if (none(good)) return out_.hold();
        const value loop = loop_(only_where(good, position(reference.position - measured)));
        const auto sound = both(good, finite(loop + rest));
        if (none(sound)) return out_.hold();
        set_where(sound, state_.q, unless_died_out(q));
        set_where(sound, state_.past, past);
        set_where(sound, state_.loop, loop);
        return out_.keep(sound, loop + rest);
    }
    /// What was applied of the last command.
    void applied(value u) noexcept { loop_.applied(state_.loop + (u - out_.last())); }
    void reset() noexcept {
        loop_.reset();
        state_ = {};
        out_.reset();
    }
    void settle(position x, value u) noexcept {
        const position past = weight_ * x - x;
        const value loop = u - set_aside_ * x;
        const auto good = finite(past, loop);
        if (none(good)) return out_.raise();
        loop_.settle(position(), only_where(good, loop));
        set_where(good, state_.q, velocity());
        set_where(good, state_.past, past);
        set_where(good, state_.loop, loop);
        out_.settle(good, u);
    }

    void retune(const pid& next, const axis_motion<Real>& reference, position measured, velocity tachometer,
                value u) noexcept {
        const position past = next.weight_ * reference.position - measured,
                       error = reference.position - measured;
        const value loop = u - (next.set_aside_ * reference.position + next.derivative_gain_ * state_.q);
        const auto good = finite(past, loop, tachometer);
        if (next.period_ != period_ || none(good)) return out_.raise();
        loop_.retune(next.loop_, only_where(good, error), only_where(good, loop));
        given_ = next.given_;
        derivative_gain_ = next.derivative_gain_;
        set_aside_ = next.set_aside_;
        weight_ = next.weight_;
        share_ = next.share_;
        set_where(good, state_.past, past);
        out_.raise(!good);
    }

    /// Of the unlimited law.
    law_response response(frequency f) const {
        const std::complex<double> back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value()),
                                   filter = share_ / (1.0 - (1 - share_) * back),
                                   derivative = detail::plain(derivative_gain_) * filter;
        const double c = detail::plain(weight_);
        law_response y;
        y.from_position = loop_.response(f);
        y.to_position = y.from_position + detail::plain(set_aside_);
        if (given_.derivative == derivative_from::tachometer) {
            y.from_velocity = derivative;
            y.to_velocity = c * derivative;
        } else {
            const std::complex<double> rate = derivative * (1.0 - back) / period_.value();
            y.from_position += rate;
            y.to_position += c * rate;
        }
        return y;
    }
    bool limited() const noexcept { return loop_.limited(); } ///< the integral was restrained
    bool faulted() const noexcept { return out_.faulted() || loop_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return either(out_.faulted_lanes(), loop_.faulted_lanes()); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    quantity<si::time, Real> time() const noexcept { return in_real<Real>(period_); }

    parameters given_;
    duration period_;
    loop_box loop_;
    gain_of<Command, signal::velocity, Real> derivative_gain_;
    gain_of<Command, signal::position, Real> set_aside_; ///< Kp (b - 1)
    Real weight_;
    double share_; ///< of a sample in q
    state state_;
    held_output<value> out_;
};
static_assert(retunable_law<pid<>>);

/// The poles that a `pid` loop is designed for: (s + real w)(s^2 + 2 damping w s + w^2), w = 2 pi natural.
struct pid_poles {
    frequency natural; ///< > 0
    double damping = 1;
    double real = 1; ///< third pole, as a multiple of w
};

/// Gains that put them there on x/u = B / (s (s + A)), weights one. In continuous time: the sampled loop is
/// close to it while w is below about a twentieth of the sampling rate in rad/s. Gains that would be negative
/// are refused by the block.
template <signal_tag Command> auto place_pid(const axis_model<Command>& plant, const pid_poles& poles) {
    require_positive("place_pid.plant.gain", plant.gain);
    require_not_negative("place_pid.plant.viscous_rate", plant.viscous_rate);
    require_positive("place_pid.natural", poles.natural);
    require_positive("place_pid.damping", poles.damping);
    require_positive("place_pid.real", poles.real);
    const double w = 2 * std::numbers::pi * poles.natural.value(), B = plant.gain.value();
    typename pid<double, Command>::parameters p;
    p.gain = decltype(p.gain)::from_value(w * w * (1 + 2 * poles.damping * poles.real) / B);
    p.integral_gain = decltype(p.integral_gain)::from_value(poles.real * w * w * w / B);
    p.derivative_gain = decltype(p.derivative_gain)::from_value(
        ((poles.real + 2 * poles.damping) * w - plant.viscous_rate.value()) / B);
    return p;
}

} // namespace quadrant::inline v0
