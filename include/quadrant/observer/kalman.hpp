// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "../block/retuned.hpp"
#include "dare.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// Position, velocity and disturbance force of an axis from its encoder and the command applied: a smooth speed
/// without the lag of a filtered derivative, and what pushes.
///   dx/dt = v, M dv/dt = kf u - viscous v + d, dd/dt = white noise; encoder = x + white noise; steady Kalman gain K
///   x = p + K (encoder - p_x),   next p = exp(F T) x + integral u   (exact for a held command)
/// With `half_step` a reading is a bounded set instead, x within half_step of it: a prediction inside stays,
/// one outside is corrected by what it is outside, with the same gain.
/// The disturbance is a state because friction and cutting forces are not white: without it the speed is biased
/// by what a constant force adds between two corrections.
/// Source: [Franklin1998] ch. 9 (steady-state optimal estimation), gain by `dare`; half_step: the dead zone of
/// a set-membership update [Fogel1982].
/// Ports: encoder in, velocity at the same sample out; the command `applied` since the sample before is the
/// second argument, read before it is written (// z^-1, no loop to solve). Positive command, force and motion
/// agree. With a delayed axis feed it the delayed command (`delay_line`).
/// State: position, velocity, force; `reset`: at rest at zero; `settle(x)`: at rest at x, nothing pushes or
/// drives; `settle(x, v)`: moving at v, driven against viscous friction by a force.
/// `retune(next)`: another model or other noise from the next step on, the estimates stay; jump: what the new
/// model predicts differently over one period, and (K' - K) times the innovation.
/// Range: encoder_noise and drift > 0 (a quantizer's noise: step / sqrt(12), white while some steps are crossed
/// per period); their ratio sets the bandwidth(). In float up to 0.1 m with steps of 0.1 um.
/// NaN and infinities in encoder or command: holds the last velocity, keeps the state, raises faulted().
/// Throws "kalman.<field> = ...: must be ..." for period, mass, force_constant, viscous, encoder_noise, drift,
/// half_step.
/// Cost: 9 multiplications, 24 bytes of state. One constant corner and no model: `filtered_derivative`.
template <signal_tag Command, class Real = double> class kalman {
public:
    using input = signal::position;
    using output = signal::velocity;
    using argument = quantity_of<signal::position, Real>;
    using value = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using command = quantity_of<Command, Real>;
    using force = quantity_of<signal::force, Real>;

    /// Mass and motor of the axis, and the noise that the gain follows from.
    struct parameters {
        quantity<si::mass, number> mass;                            ///< > 0
        gain_of<signal::force, Command, number> force_constant;     ///< > 0
        gain_of<signal::force, signal::velocity, number> viscous{}; ///< >= 0
        quantity_of<signal::position, number> encoder_noise;        ///< standard deviation of a reading; > 0
        quantity_of<signal::force, number> drift; ///< deviation that d gathers in one second; > 0
        quantity_of<signal::position, number>
            half_step{}; ///< of a quantizer taken as a bounded set; >= 0; 0: as noise
    };
    /// The estimates: position [m], velocity [m/s], disturbing force [N].
    struct state {
        argument position{};
        value velocity{};
        force disturbance{};
    };

    kalman(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("kalman.period", period);
        require_positive<Real>("kalman.mass", p.mass);
        require_positive<Real>("kalman.force_constant", p.force_constant);
        require_not_negative<Real>("kalman.viscous", p.viscous);
        require_positive<Real>("kalman.encoder_noise", p.encoder_noise);
        require_positive<Real>("kalman.drift", p.drift);
        require_not_negative<Real>("kalman.half_step", p.half_step);
        half_step_ = Real(p.half_step.value());
        // In units of the encoder's noise, the period, and the force that moves the mass by one in the other:
        // all of order one.
        const number T(period.value()), sigma = p.encoder_noise.value(), mass = p.mass.value();
        const number slow = p.viscous.value() * T / mass, thrust = T * T / (mass * sigma);
        const number wander = p.drift.value() * thrust;
        const matrix<3, 3, number> f{{{0, 1, 0}, {0, -slow, 1}, {0, 0, 0}}};
        const column<3, number> g{0, p.force_constant.value() * thrust, 0};
        matrix<3, 3, number> noise{};
        noise[2][2] = wander * wander * T;
        const auto s = sampled(f, g, noise, 1.0);
        const auto k = kalman_gain(s.step, column<3, number>{1, 0, 0}, s.noise, number(1));
        const column<3, number> unit{sigma, sigma / T, 1 / thrust}; // of the states, in SI
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) step_[i][j] = Real(s.step[i][j] * unit[i] / unit[j]);
            from_command_[i] = Real(s.from_input[i] * unit[i]);
            gain_[i] = Real(k.gain[i] * unit[i] / sigma);
            const double share =
                detail::plain(k.predicted[i][i]) - detail::plain(k.gain[i] * k.predicted[0][i]);
            deviation_[i] = std::sqrt(share > 0 ? share : 0.0) * detail::plain(unit[i]);
        }
        innovation_deviation_ = std::sqrt(detail::plain(k.innovation)) * detail::plain(sigma);
        radius_ = k.radius;
    }

    /// Velocity now, from the encoder now and the command that acted since the sample before.
    value operator()(argument encoder, command applied = command()) noexcept {
        const Real x = state_.position.value(), v = state_.velocity.value(), d = state_.disturbance.value(),
                   u = applied.value();
        const Real px = x + (step_[0][1] * v + step_[0][2] * d + from_command_[0] * u);
        const Real pv = step_[1][1] * v + step_[1][2] * d + from_command_[1] * u;
        const Real off = outside(encoder.value() - px);
        const Real nx = px + gain_[0] * off, nv = pv + gain_[1] * off, nd = d + gain_[2] * off;
        if (!finite(encoder, nx, nv, nd)) return out_.hold();
        state_ = {unless_died_out(argument::from_value(nx)), unless_died_out(value::from_value(nv)),
                  unless_died_out(force::from_value(nd))};
        innovation_ = argument::from_value(off);
        return out_.keep(state_.velocity);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument position) noexcept { settle(position, value()); }
    void settle(argument position, value velocity) noexcept {
        const force held = in_real<Real>(given_.viscous) * velocity;
        if (!finite(position, velocity, held)) return out_.raise();
        state_ = {position, velocity, held};
        innovation_ = argument();
        out_.reset(velocity);
    }

    void retune(const kalman& next) noexcept {
        detail::retuned(*this, next, next.period_ == period_, out_, state_, innovation_);
    }

    const argument& position() const noexcept { return state_.position; }
    const value& velocity() const noexcept { return state_.velocity; }
    const force& disturbance() const noexcept { return state_.disturbance; }
    /// Encoder minus what was expected; with half_step what of it lies outside.
    const argument& innovation() const noexcept { return innovation_; }
    /// Standard deviations that the model expects: of the estimates (position, velocity, disturbance) and of
    /// the innovation.
    struct deviations {
        quantity_of<signal::position> position;
        quantity_of<signal::velocity> velocity;
        quantity_of<signal::force> disturbance;
        quantity_of<signal::position> innovation;
    };
    deviations expected() const noexcept {
        return {deviation_[0] * si::meter, deviation_[1] * si::meter_per_second, deviation_[2] * si::newton,
                innovation_deviation_ * si::meter};
    }
    /// Of the slowest mode of the error, in hertz: errors die out as exp(-2 pi bandwidth t).
    frequency bandwidth() const {
        return frequency::from_value(-std::log(radius_) / (2 * std::numbers::pi * period_.value()));
    }
    /// From encoder to velocity, no command, without half_step.
    std::complex<double> response(frequency f) const {
        using complex = std::complex<double>;
        const complex back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value());
        matrix<3, 3, complex> a = detail::identity<3, complex>();
        matrix<3, 1, complex> k{};
        for (std::size_t i = 0; i < 3; ++i) {
            k[i][0] = detail::plain(gain_[i]);
            for (std::size_t j = 0; j < 3; ++j)
                a[i][j] -=
                    back * (detail::plain(step_[i][j]) - detail::plain(gain_[i]) * detail::plain(step_[0][j]));
        }
        return detail::solved(a, k)[1][0];
    }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    Real outside(Real off) const noexcept {
        return off > half_step_ ? off - half_step_ : off < -half_step_ ? off + half_step_ : Real(0);
    }

    parameters given_;
    duration period_;
    Real half_step_{};
    matrix<3, 3, Real> step_{};
    column<3, Real> from_command_{}, gain_{};
    column<3> deviation_{};
    double innovation_deviation_ = 0, radius_ = 0;
    state state_;
    argument innovation_{};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
