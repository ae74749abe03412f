// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/signal.hpp"
#include "../base/standstill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// What stands between a current command and the force of a linear motor: three phases, an inverter, two PI
/// controllers of the current in the frame of the magnets. Where lag, ripple and limits of a drive come from.
///   L di/dt = v - R i - e,  e = speed kf/1.5 across the magnets,  force = kf i_q        (stationary frame, exact for held v, e)
///   v_d = PI(0 - i_d), v_q = PI(demand - i_q), |v| <= bus/sqrt(3)
///   PI with zero on the motor's pole: bandwidth w, kp = w L, ki = w R
/// Source: the drive of [LowKeck2003] (PWM inverter, two PI in the rotor frame); frames and PI: [Ellis2012].
/// Errors of a real drive: commutation_offset (angle by which the controller takes the magnets for elsewhere:
/// force falls with its cosine), gain_error and current_offset of the sensor of phase a (force ripples twice,
/// once a pole pair).
/// Ports: command in amperes of i_q, then position and speed of the mover at the start of the period (default
/// 0); mean force of the period out. Into a mass by its external force: motor(0_V, drive(u, x, v)).
/// State: currents alpha, beta; integrals of both PI. `reset`: no current; `settle(u, x)`: at rest at x,
/// holding u, as far as the bus gives it.
/// Range: current_limit of the command; steps of the current loop a period, 1 ... 1000, bandwidth below 1/12 of
/// their rate. With switching the legs switch once a step, centre-aligned, and the current ripples; without, v
/// is its mean.
/// NaN and infinities: holds the last force, keeps the state, raises faulted(). limited(): command or voltage
/// was clipped. Throws "three_phase_drive.<field> = ...: must ..." for every field and the period.
/// Cost: about 6 sines and 60 multiplications a step, seven times the latter with switching. A lag alone:
/// `lowpass`; ripple
/// alone: `force_ripple`.
template <class Real = double> class three_phase_drive {
public:
    using input = signal::current;
    using output = signal::force;
    using argument = quantity_of<signal::current, Real>;
    using value = quantity_of<signal::force, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// Motor, inverter and current controller, with the errors that they have.
    struct parameters {
        gain_of<signal::force, signal::current, number> force_constant; ///< kf, of the amplitude; > 0
        gain_of<signal::voltage, signal::current, number> resistance;   ///< of a phase; > 0
        quantity<si::time, number> time_constant;                       ///< L/R; > 0
        quantity_of<signal::position, number> pole_pair;                ///< length of one; > 0
        quantity_of<signal::voltage, number> bus;                       ///< > 0
        quantity_of<signal::current, number> current_limit;             ///< of the command; > 0
        frequency bandwidth;                                            ///< of the current loop; > 0, see range
        std::size_t steps = 10;                                         ///< of the current loop in a period
        bool switching = false;                                         ///< else the inverter gives the mean
        number commutation_offset = 0;                                  ///< electrical, in radians; finite
        number gain_error = 0;                                          ///< of the sensor of phase a; > -1
        quantity_of<signal::current, number> current_offset{};          ///< likewise; finite
    };
    /// Currents of the motor in the frame that stands, integrals of both controllers in that of the magnets.
    struct state {
        Real alpha{}, beta{};    ///< currents [A]
        Real held_d{}, held_q{}; ///< integrals [V]
    };

    three_phase_drive(const parameters& p, duration period) : given_(checked(p, period)) {
        force_constant_ = Real(p.force_constant.value());
        resistance_ = Real(p.resistance.value());
        time_constant_ = Real(p.time_constant.value());
        wave_ = Real(number(2 * std::numbers::pi) / p.pole_pair.value());
        bus_ = Real(p.bus.value());
        limit_ = Real(p.current_limit.value());
        step_ = Real(period.value() / double(p.steps));
        const double w = 2 * std::numbers::pi * p.bandwidth.value();
        gain_ = Real(number(w) * p.resistance.value() * p.time_constant.value());
        integral_ = Real(number(w * period.value() / double(p.steps)) * p.resistance.value());
        require_coefficients<Real>("three_phase_drive.time_constant", p.time_constant,
                                   number(w) * p.resistance.value() * p.time_constant.value());
        require_coefficients<Real>("three_phase_drive.gain_error", p.gain_error, p.gain_error);
        offset_ = Real(p.commutation_offset);
        sensor_gain_ = Real(number(1) + p.gain_error);
        sensor_offset_ = Real(p.current_offset.value());
    }

    value operator()(argument demand, position x = position(), velocity v = velocity()) noexcept {
        if (!finite(demand, x, v)) return out_.hold();
        const Real wanted = within(demand.value(), limit_);
        bool clipped = wanted != demand.value();
        state s = state_;
        Real at = x.value(), sum(0);
        for (std::size_t k = 0; k < given_.steps; ++k, at += v.value() * step_) {
            const auto [va, vb, weak] = controlled(s, wanted, wave_ * at + offset_);
            clipped = clipped || weak;
            sum +=
                given_.switching ? switched(s, va, vb, at, v.value()) : held(s, va, vb, at, v.value(), step_);
        }
        const value force = value::from_value(force_constant_ * sum / (step_ * Real(double(given_.steps))));
        if (!finite(force, s.alpha, s.beta, s.held_d, s.held_q)) return out_.hold();
        for (Real* each : {&s.alpha, &s.beta, &s.held_d, &s.held_q}) *each = unless_died_out(*each);
        state_ = s;
        limited_ = clipped;
        return out_.keep(force);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument demand, position x = position()) noexcept {
        if (!finite(demand, x)) return out_.raise();
        // Both sensors say what the controller wants; what flows then is what they are wrong by.
        const Real i = within(demand.value(), limit_), angle = wave_ * x.value(), seen = angle + offset_;
        const Real a = turned_alpha(Real(0), i, seen), root = Real(std::numbers::sqrt3),
                   b = (root * turned_beta(Real(0), i, seen) - a) * Real(0.5);
        state s;
        s.alpha = (a - sensor_offset_) / sensor_gain_;
        s.beta = (Real(2) * b + s.alpha) / root;
        s.held_d = resistance_ * turned_alpha(s.alpha, s.beta, -seen);
        s.held_q = resistance_ * turned_beta(s.alpha, s.beta, -seen);
        state_ = s;
        limited_ = false;
        out_.reset(value::from_value(force_constant_ * turned_beta(s.alpha, s.beta, -angle)));
    }

    bool limited() const noexcept { return limited_; }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    struct command {
        Real alpha, beta; ///< [V]
        bool weak;        ///< the bus does not give more
    };

    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("three_phase_drive.period", period);
        require_positive<Real>("three_phase_drive.force_constant", p.force_constant);
        require_positive<Real>("three_phase_drive.resistance", p.resistance);
        require_positive<Real>("three_phase_drive.time_constant", p.time_constant);
        require_positive<Real>("three_phase_drive.pole_pair", p.pole_pair);
        require_positive<Real>("three_phase_drive.bus", p.bus);
        require_positive<Real>("three_phase_drive.current_limit", p.current_limit);
        require(p.steps >= 1 && p.steps <= 1000, "three_phase_drive.steps", double(p.steps),
                "must lie between 1 and 1000");
        const double most = double(p.steps) / period.value() / 12;
        require(p.bandwidth.value() > 0 && p.bandwidth.value() <= most, "three_phase_drive.bandwidth",
                p.bandwidth,
                "must be above 0 and at most 1/12 of the current loop's rate (" +
                    detail::shortest(detail::in_unit(most, " Hz")) + ")");
        require_finite<Real>("three_phase_drive.commutation_offset", p.commutation_offset);
        require(detail::is_finite(detail::plain(p.gain_error)) && detail::plain(p.gain_error) > -1,
                "three_phase_drive.gain_error", p.gain_error, "must be finite and above -1");
        require_finite<Real>("three_phase_drive.current_offset", p.current_offset);
        return p;
    }
    static Real within(Real x, Real most) noexcept { return x > most ? most : x < -most ? -most : x; }
    static Real turned_alpha(Real d, Real q, Real angle) noexcept {
        using std::cos, std::sin;
        return d * Real(cos(angle)) - q * Real(sin(angle));
    }
    static Real turned_beta(Real d, Real q, Real angle) noexcept {
        using std::cos, std::sin;
        return d * Real(sin(angle)) + q * Real(cos(angle));
    }
    /// Both PI, in the frame that the controller believes in.
    command controlled(state& s, Real wanted, Real angle) const noexcept {
        using std::sqrt;
        const Real third = Real(1 / std::numbers::sqrt3);
        const Real a = sensor_gain_ * s.alpha + sensor_offset_,
                   b = Real(-0.5) * s.alpha + s.beta / (Real(2) * third);
        const Real alpha = a, beta = (a + Real(2) * b) * third; // from phases a and b
        const Real off_d = -turned_alpha(alpha, beta, -angle),
                   off_q = wanted - turned_beta(alpha, beta, -angle);
        Real d = s.held_d + gain_ * off_d, q = s.held_q + gain_ * off_q;
        const Real most = bus_ * third, size2 = d * d + q * q;
        const bool weak = size2 > most * most;
        if (weak) { // and the integrals wait
            const Real share = most / Real(sqrt(size2));
            d *= share, q *= share;
        } else
            s.held_d += integral_ * off_d, s.held_q += integral_ * off_q;
        return {turned_alpha(d, q, angle), turned_beta(d, q, angle), weak};
    }
    /// Integral of i_q over h, voltages held; moves the currents on.
    Real held(state& s, Real va, Real vb, Real at, Real speed, Real h) const noexcept {
        using std::cos, std::exp, std::sin;
        const Real middle = wave_ * (at + Real(0.5) * speed * h), kept = exp(-h / time_constant_),
                   emf = force_constant_ / Real(1.5) * speed;
        const Real before = turned_beta(s.alpha, s.beta, -wave_ * at);
        s.alpha = s.alpha * kept + (va + emf * Real(sin(middle))) / resistance_ * (Real(1) - kept);
        s.beta = s.beta * kept + (vb - emf * Real(cos(middle))) / resistance_ * (Real(1) - kept);
        return Real(0.5) * h * (before + turned_beta(s.alpha, s.beta, -wave_ * (at + speed * h)));
    }
    /// The same with each leg on for its share of the step, about the middle, neutral point in the middle of
    /// the bus.
    Real switched(state& s, Real va, Real vb, Real at, Real speed) const noexcept {
        const Real root = Real(std::numbers::sqrt3 / 2);
        std::array<Real, 3> leg{va, Real(-0.5) * va + root * vb, Real(-0.5) * va - root * vb};
        const Real common =
            Real(0.5) * (std::max({leg[0], leg[1], leg[2]}) + std::min({leg[0], leg[1], leg[2]}));
        std::array<Real, 8> edge{Real(0), {}, {}, {}, {}, {}, {}, step_};
        for (std::size_t k = 0; k < 3; ++k) {
            leg[k] = Real(0.5) * within((leg[k] - common) / bus_, Real(0.5)) *
                     step_; // half of what it is on beyond half
            edge[1 + k] = Real(0.25) * step_ - leg[k];
            edge[4 + k] = Real(0.75) * step_ + leg[k];
        }
        std::sort(edge.begin(), edge.end());
        Real sum(0);
        for (std::size_t k = 0; k + 1 < edge.size(); ++k) {
            const Real h = edge[k + 1] - edge[k],
                       middle = Real(0.5) * (edge[k] + edge[k + 1]) - Real(0.5) * step_;
            std::array<Real, 3> on{};
            for (std::size_t l = 0; l < 3; ++l) {
                const Real reach = Real(0.25) * step_ + leg[l];
                on[l] = middle < reach && middle > -reach ? bus_ : Real(0);
            }
            sum += held(s, (Real(2) * on[0] - on[1] - on[2]) / Real(3), (on[1] - on[2]) / (Real(2) * root),
                        at + speed * edge[k], speed, h);
        }
        return sum;
    }

    parameters given_;
    Real force_constant_{}, resistance_{}, time_constant_{}, wave_{}, bus_{}, limit_{}, step_{};
    Real gain_{}, integral_{}, offset_{}, sensor_gain_{}, sensor_offset_{};
    bool limited_ = false;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
