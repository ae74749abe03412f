// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "../block/retuned.hpp"
#include "../filter/viscous_step.hpp"
#include "../observer/dare.hpp"
#include "../observer/nominal_plant.hpp"
#include "axis_law.hpp"
#include "diophantine.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// A control law of a feed drive on estimated states: position, velocity and disturbance from the encoder and
/// the command that was applied (steady Kalman gain), the disturbance cancelled, the plant inverted for the
/// reference.
///   u = k1 (x_ref - x^) + k2 (v_ref - v^) + (a_ref + A v_ref)/B - d^
///   prediction: the axis x/u = B / (s (s + A)) over a period under u_applied + d^, exact;  estimate = prediction + L (x - its x)
/// Source: [Franklin1998] ch. 8 (pole placement), ch. 9 (observer gain by `dare`); [Yeung2006] names the law.
/// Ports: those of `axis_law`; the tachometer is not read.
/// State: the three estimates and the command applied. `reset` at rest at zero; `settle(x, u)`: at rest at x,
/// d^ = -u.
/// `retune(next, ...)`: as `retunable_law` says; the estimates stay (they are of the axis, not of the law),
/// and nothing takes up what the gains change. Jump: (k1' - k1) (x_ref - x^) + (k2' - k2) (v_ref - v^) + (1/B'
/// - 1/B) a_ref + (A'/B' - A/B) v_ref, and k1, k2, 1 times what the estimates of one sample differ by under
/// the new model.
/// Limits: nothing winds up, as applied(u) reports to the observer what drove the axis.
/// Range: B > 0, A >= 0; k1, k2 such that the sampled loop on the true states is stable (with those of the
/// observer these are all poles of the loop). encoder_noise and drift > 0: their ratio sets the observer, see
/// `kalman`.
/// NaN and infinities: holds the last command, keeps the state, raises faulted().
/// Throws "state_feedback.<field> = ...: must ..." for all fields; dare in its own name.
/// Cost: 15 multiplications, 32 bytes of state. The estimates alone: `kalman`. By polynomials: `rst`.
template <class Real = double, signal_tag Command = signal::voltage> class state_feedback {
public:
    using output = Command;
    using value = quantity_of<Command, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The axis as believed, gains of its states, and the noise that the observer's gain follows from.
    struct parameters {
        axis_model<Command, number> plant;                        ///< as the law believes it
        gain_of<Command, signal::position, number> position_gain; ///< k1
        gain_of<Command, signal::velocity, number> velocity_gain; ///< k2
        quantity_of<signal::position, number> encoder_noise;      ///< standard deviation of a reading; > 0
        quantity_of<Command, number> drift;                       ///< deviation that d gathers in a second; > 0
    };
    /// The estimates at the last sample, and the command that acts since then.
    struct state {
        position x{};
        velocity v{};
        value disturbance{}, applied{};
    };

    state_feedback(const parameters& p, duration period)
        : given_(checked(p, period)), period_(period), position_gain_(in_real<Real>(p.position_gain)),
          velocity_gain_(in_real<Real>(p.velocity_gain)) {
        const number A = p.plant.viscous_rate.value(), B = p.plant.gain.value(), T(period.value());
        const viscous_step<number> step(A, T);
        kept_ = Real(step.kept);
        gained_ = in_real<Real>(quantity<si::time, number>::from_value(step.gained));
        driven_ = in_real<Real>(gain_of<signal::velocity, Command, number>::from_value(B * step.gained));
        moved_ = in_real<Real>(gain_of<signal::position, Command, number>::from_value(B * step.way));
        inertia_ = in_real<Real>(gain_of<Command, signal::acceleration, number>::from_value(number(1) / B));
        drag_ = in_real<Real>(gain_of<Command, signal::velocity, number>::from_value(A / B));
        // In units of the encoder's noise, the period, and the command that moves the axis by one in the other.
        const number sigma = p.encoder_noise.value(), thrust = B * T * T / sigma,
                     wander = p.drift.value() * thrust;
        const matrix<3, 3, number> f{{{0, 1, 0}, {0, -A * T, 1}, {0, 0, 0}}};
        matrix<3, 3, number> noise{};
        noise[2][2] = wander * wander * T;
        const auto s = sampled(f, column<3, number>{}, noise, 1.0);
        const auto k = kalman_gain(s.step, column<3, number>{1, 0, 0}, s.noise, number(1));
        to_position_ = Real(k.gain[0]);
        to_velocity_ =
            in_real<Real>(gain_of<signal::velocity, signal::position, number>::from_value(k.gain[1] / T));
        to_disturbance_ =
            in_real<Real>(gain_of<Command, signal::position, number>::from_value(k.gain[2] / (thrust * sigma)));
        const double k1 = detail::plain(p.position_gain), k2 = detail::plain(p.velocity_gain);
        const double pushed = detail::plain(moved_), sped = detail::plain(driven_);
        const double loop =
            spectral_radius(matrix<2>{{{1 - pushed * k1, detail::plain(step.gained) - pushed * k2},
                                       {-sped * k1, detail::plain(step.kept) - sped * k2}}});
        require(loop < 1, "state_feedback.position_gain", p.position_gain,
                "must with velocity_gain leave the loop stable (largest pole " + detail::shortest(loop) + ")");
    }

    value operator()(const axis_motion<Real>& reference, position measured, velocity tachometer) noexcept {
        const value drive = state_.applied + state_.disturbance;
        const position px = state_.x + (gained_ * state_.v + moved_ * drive), off = measured - px;
        const velocity v = kept_ * state_.v + driven_ * drive + to_velocity_ * off;
        const position x = px + to_position_ * off;
        const value d = state_.disturbance + to_disturbance_ * off;
        const value u = position_gain_ * (reference.position - x) + velocity_gain_ * (reference.velocity - v) +
                        inertia_ * reference.acceleration + drag_ * reference.velocity - d;
        if (!finite(x, v, d, u, tachometer)) return out_.hold();
        state_ = {unless_died_out(x), unless_died_out(v), unless_died_out(d), unless_died_out(u)};
        return out_.keep(u);
    }
    /// What was applied of the last command.
    void applied(value u) noexcept {
        if (!finite(u)) return out_.raise();
        state_.applied = u;
    }
    void reset() noexcept { settle(position(), value()); }
    void settle(position x, value u) noexcept {
        if (!finite(x, u)) return out_.raise();
        state_ = {x, velocity(), -u, u};
        out_.reset(u);
    }

    void retune(const state_feedback& next, const axis_motion<Real>&, position, velocity, value) noexcept {
        detail::retuned(*this, next, next.period_ == period_, out_, state_);
    }

    /// Of the unlimited law.
    law_response response(frequency f) const {
        using complex = std::complex<double>;
        const auto bare = [](const auto& q) { return detail::plain(q); };
        const complex back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value());
        const column<3> gain{bare(to_position_), bare(to_velocity_), bare(to_disturbance_)},
            weight{bare(position_gain_), bare(velocity_gain_), 1}, from_command{bare(moved_), bare(driven_), 0};
        const matrix<3> step{{{1, bare(gained_), bare(moved_)}, {0, bare(kept_), bare(driven_)}, {0, 0, 1}}};
        // s = (1 - gain [1 0 0]) (step s + from_command u) / z + gain x,  u = w - weight s
        matrix<3, 3, complex> m = detail::identity<3, complex>();
        matrix<3, 2, complex> right{}; // from w, from x
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j)
                m[i][j] -= back * (step[i][j] - gain[i] * step[0][j] -
                                   (from_command[i] - gain[i] * from_command[0]) * weight[j]);
            right[i] = {back * (from_command[i] - gain[i] * from_command[0]), gain[i]};
        }
        const auto s = detail::solved(m, right);
        complex through = 1, fed_back = 0;
        for (std::size_t i = 0; i < 3; ++i) through -= weight[i] * s[i][0], fed_back += weight[i] * s[i][1];
        law_response y;
        y.to_position = bare(position_gain_) * through;
        y.to_velocity = (bare(velocity_gain_) + bare(drag_)) * through;
        y.to_acceleration = bare(inertia_) * through;
        y.from_position = fed_back;
        return y;
    }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("state_feedback.period", period);
        require_positive<Real>("state_feedback.plant.gain", p.plant.gain);
        require_not_negative<Real>("state_feedback.plant.viscous_rate", p.plant.viscous_rate);
        require_finite<Real>("state_feedback.position_gain", p.position_gain);
        require_finite<Real>("state_feedback.velocity_gain", p.velocity_gain);
        require_positive<Real>("state_feedback.encoder_noise", p.encoder_noise);
        require_positive<Real>("state_feedback.drift", p.drift);
        return p;
    }

    parameters given_;
    duration period_;
    gain_of<Command, signal::position, Real> position_gain_, to_disturbance_;
    gain_of<Command, signal::velocity, Real> velocity_gain_, drag_;
    gain_of<Command, signal::acceleration, Real> inertia_;
    Real kept_{}, to_position_{};
    quantity<si::time, Real> gained_;
    gain_of<signal::velocity, Command, Real> driven_;
    gain_of<signal::position, Command, Real> moved_;
    gain_of<signal::velocity, signal::position, Real> to_velocity_;
    state state_;
    held_output<value> out_;
};
static_assert(retunable_law<state_feedback<>>);

/// What a `state_feedback` shall do.
struct state_feedback_poles {
    frequency natural;                             ///< > 0, below half the sampling rate
    double damping = 0.7;                          ///< > 0
    quantity_of<signal::position> encoder_noise{}; ///< of a scale of steps q: q / sqrt(12)
};

/// k1, k2 that put the poles of the sampled loop where those of s^2 + 2 damping w s + w^2 go; `drift` as
/// `state_feedback`.
template <signal_tag Command>
auto place_state_feedback(const axis_model<Command>& plant, const state_feedback_poles& wanted,
                          quantity_of<Command> drift, duration period) {
    require_positive("place_state_feedback.plant.gain", plant.gain);
    require_not_negative("place_state_feedback.plant.viscous_rate", plant.viscous_rate);
    require_below_nyquist("place_state_feedback.natural", wanted.natural, period);
    require_positive("place_state_feedback.damping", wanted.damping);
    // Trace and determinant of step - from_command k, linear in k as from_command k has rank one.
    const viscous_step<> step(plant.viscous_rate.value(), period.value());
    const double B = plant.gain.value();
    const auto pole = pole_pair(wanted.natural, wanted.damping, period);
    const matrix<2> m{{{B * step.way, B * step.gained},
                       {B * (step.kept * step.way - step.gained * step.gained), B * step.gained}}};
    const auto k = detail::solved(m, matrix<2, 1>{{{1 + step.kept + pole[1]}, {step.kept - pole[2]}}});
    typename state_feedback<double, Command>::parameters p;
    p.plant = plant;
    p.position_gain = decltype(p.position_gain)::from_value(k[0][0]);
    p.velocity_gain = decltype(p.velocity_gain)::from_value(k[1][0]);
    p.encoder_noise = wanted.encoder_noise;
    p.drift = drift;
    return p;
}

} // namespace quadrant::inline v0
