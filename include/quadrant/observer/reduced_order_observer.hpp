// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "../block/retuned.hpp"

#include <complex>
#include <numbers>

namespace quadrant::inline v0 {

/// Velocity and disturbance force from position and acceleration, both measured: the acceleration is
/// integrated, the position keeps the integral from drifting. No lag, and the encoder's steps are filtered.
///   dv/dt = a + l1 (dx/dt - v),   d = M a + viscous v - kf u,   l1 = 2 pi corner
///   (v - v')/T = (a + a')/2 + l1 ((x - x')/T - (v + v')/2)       (' = one sample before)
/// The third state, the position, is measured; of the two gains of L = [l1 0] only the one on the position is
/// not zero, as the acceleration already is the derivative of the velocity.
/// Source: [Jamaludin2008] Appendix C; the trapezoidal form is exact for a constant acceleration.
/// Ports: position in, velocity at the same sample out; second and third argument the acceleration now and the
/// command that acts at this sample (the last one, // z^-1). d is positive in the direction of positive motion.
/// State: velocity, last position and acceleration; `reset`: at rest at zero; `settle(x)`: at rest at x;
/// `settle(x, v)`: moving at v, x was the last sample.
/// `retune(next)`: another corner or model from the next step on; v is off by at most the change of 2 h / (1 +
/// h), h = pi corner T, times |(x - x')/T - v' - T (a + a')/4| (' = one sample before).
/// Range: 0 < corner < half the sampling rate. An offset Z of the acceleration leaves Z / l1 in v: calibrate it
/// (`analysis/ferraris_calibration.hpp`). The disturbance is not filtered: `ferraris_force_estimator`.
/// NaN and infinities in any argument: holds the last velocity, keeps the state, raises faulted().
/// Throws "reduced_order_observer.<field> = ...: must ..." for period, mass, force_constant, viscous, corner.
/// Cost: 6 multiplications, 32 bytes of state. Without an acceleration sensor: `kalman`.
template <signal_tag Command, class Real = double> class reduced_order_observer {
public:
    using input = signal::position;
    using output = signal::velocity;
    using argument = quantity_of<signal::position, Real>;
    using value = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using acceleration = quantity_of<signal::acceleration, Real>;
    using command = quantity_of<Command, Real>;
    using force = quantity_of<signal::force, Real>;

    /// Mass and motor of the axis, and where position takes over from acceleration.
    struct parameters {
        quantity<si::mass, number> mass;                            ///< > 0
        gain_of<signal::force, Command, number> force_constant;     ///< kf > 0
        gain_of<signal::force, signal::velocity, number> viscous{}; ///< >= 0
        quantity<hertz_unit, number> corner; ///< l1 / (2 pi): position below, acceleration above it
    };
    /// The last measurements, and velocity [m/s] and disturbing force [N] made from them.
    struct state {
        argument position{};
        value velocity{};
        acceleration accelerated{};
        force disturbance{};
    };

    reduced_order_observer(const parameters& p, duration period)
        : given_(p), period_(period), mass_(in_real<Real>(p.mass)),
          force_constant_(in_real<Real>(p.force_constant)), viscous_(in_real<Real>(p.viscous)) {
        require_positive<Real>("reduced_order_observer.period", period);
        require_positive<Real>("reduced_order_observer.mass", p.mass);
        require_positive<Real>("reduced_order_observer.force_constant", p.force_constant);
        require_not_negative<Real>("reduced_order_observer.viscous", p.viscous);
        require_below_nyquist("reduced_order_observer.corner", p.corner, period);
        const number h = std::numbers::pi * p.corner.value() * period.value(); // l1 T / 2
        forget_ = Real(2 * h / (1 + h));
        from_position_ = gain_of<signal::velocity, signal::position, Real>::from_value(
            Real(2 * h / (1 + h) / period.value()));
        from_acceleration_ = quantity<si::time, Real>::from_value(Real(period.value() / 2 / (1 + h)));
    }

    value operator()(argument position, acceleration a = acceleration(), command applied = command()) noexcept {
        const value v = unless_died_out(state_.velocity + (from_acceleration_ * (a + state_.accelerated) +
                                                           from_position_ * (position - state_.position) -
                                                           forget_ * state_.velocity));
        const force d = mass_ * a + viscous_ * v - force_constant_ * applied;
        if (!finite(position, v, d)) return out_.hold();
        state_ = {position, v, a, d};
        return out_.keep(v);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument position) noexcept { settle(position, value()); }
    void settle(argument position, value velocity) noexcept {
        const force d = viscous_ * velocity;
        if (!finite(position, velocity, d)) return out_.raise();
        state_ = {position, velocity, acceleration(), d};
        out_.reset(velocity);
    }

    void retune(const reduced_order_observer& next) noexcept {
        detail::retuned(*this, next, next.period_ == period_, out_, state_);
    }

    const value& velocity() const noexcept { return state_.velocity; }
    const force& disturbance() const noexcept { return state_.disturbance; }
    /// From position to velocity, and from acceleration to velocity [s]: their sum, with a the second
    /// derivative of x, is the derivative of x.
    std::complex<double> response(frequency f) const {
        const auto back = shift(f);
        return detail::plain(from_position_) * (1.0 - back) / (1.0 - (1 - detail::plain(forget_)) * back);
    }
    std::complex<double> response_to_acceleration(frequency f) const {
        const auto back = shift(f);
        return detail::plain(from_acceleration_) * (1.0 + back) / (1.0 - (1 - detail::plain(forget_)) * back);
    }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    std::complex<double> shift(frequency f) const {
        return std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value());
    }

    parameters given_;
    duration period_;
    quantity<si::mass, Real> mass_;
    gain_of<signal::force, Command, Real> force_constant_;
    gain_of<signal::force, signal::velocity, Real> viscous_;
    Real forget_{};
    gain_of<signal::velocity, signal::position, Real> from_position_;
    quantity<si::time, Real> from_acceleration_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
