// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "oscillator.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// One mode of a machine beside its rigid axis; the same numbers as `analysis::flexible_mode`.
template <class Number = double> struct machine_mode {
    quantity<hertz_unit, Number> centre; ///< undamped; > 0
    Number damping{};                    ///< ratio zeta; 0 <= it < 1
    Number share{};                      ///< of its motion in that of the rigid axis, signed; finite
};

/// What a mode of the machine's base is made from.
template <class Number = double> struct machine_base {
    quantity<si::mass, Number> slide;   ///< that the motor drives; > 0
    quantity<si::mass, Number> base;    ///< that its reaction shakes; > 0
    quantity<hertz_unit, Number> bolts; ///< of the base alone on its bolts; > 0
    Number damping{};                   ///< ratio zeta; 0 <= it < 1
};
/// The base on its bolts as a mode: the encoder measures the slide against it, so that
///   centre = bolts, share = slide/base, anti-resonance at bolts/sqrt(1 + slide/base): base and slide together on the bolts
/// Derivation: docs/derivations/flexible_modes.md.
template <class Number> machine_mode<Number> base_mode(const machine_base<Number>& b) {
    require_positive("machine_base.slide", b.slide);
    require_positive("machine_base.base", b.base);
    return {b.bolts, b.damping, Number(b.slide / b.base)};
}

/// What the structure adds to the position of an axis: modes in parallel, excited by the force of its motor.
///   q_i'' + 2 zeta_i w_i q_i' + w_i^2 q_i = share_i F/M,   y = sum q_i,   reading = rigid axis + y
/// The step is exact for a force held over the period. On a free mass a mode makes an anti-resonance at
/// centre/sqrt(1 + share): share > 0 below it (base; collocated), -1 < share < 0 above it, share <= -1 none
/// (motor and encoder move against each other).
/// Source: modal superposition [Altintas2012] chapter 3; form and anti-resonance:
/// docs/derivations/flexible_modes.md.
/// Ports: F[k] [N], held from sample k on, in; y [m] at sample k+1 out, as a plant's reading. Positive force
/// and share move the reading forward.
/// State: deflection [m] and its speed [m/s] of each mode. `reset`: at rest; `settle(F)`: bent by a constant F.
/// Range: any centre, also above half the sampling rate: the step is exact there too.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "flexible_modes.<field> = ...: must ..." for the period, mass, centre, damping, share.
/// Cost: 6 multiplications and 16 bytes of state per mode. To take a resonance out of a wire: `notch`.
template <std::size_t Modes, class Real = double>
requires(Modes > 0) class flexible_modes {
public:
    using input = signal::force;
    using output = signal::position;
    using argument = quantity_of<signal::force, Real>;
    using value = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The modes, and the mass whose motion they are shares of.
    struct parameters {
        quantity<si::mass, number> mass; ///< of the rigid axis; > 0
        std::array<machine_mode<number>, Modes> modes{};
    };
    /// How far each mode is bent [m], and how fast it moves [m/s].
    struct state {
        std::array<value, Modes> deflection{};
        std::array<quantity_of<signal::velocity, Real>, Modes> speed{};
    };

    flexible_modes(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("flexible_modes.period", period);
        require_positive<Real>("flexible_modes.mass", p.mass);
        for (std::size_t i = 0; i < Modes; ++i) {
            const auto& m = p.modes[i];
            require_positive<Real>("flexible_modes.centre", m.centre);
            require(m.damping >= number(0) && m.damping < number(1), "flexible_modes.damping", m.damping,
                    "must not be below 0 and must be below 1");
            require_finite<Real>("flexible_modes.share", m.share);
            const detail::oscillator<number> bell(m.centre.value(), m.damping, number(period.value()));
            const number compliance = m.share / (p.mass.value() * bell.stiffness);
            require_coefficients<Real>("flexible_modes.centre", m.centre, bell.onward, bell.back, compliance);
            steps_[i] = {.away = Real(bell.stay - number(1)),
                         .onward = Real(bell.onward),
                         .back = Real(bell.back),
                         .loss = Real(bell.keep - number(1)),
                         .compliance = Real(compliance)};
        }
    }

    value operator()(argument force) noexcept {
        state next;
        value sum{};
        bool good = finite(force);
        for (std::size_t i = 0; i < Modes; ++i) {
            const step& m = steps_[i];
            const Real bent = m.compliance * force.value(), q = state_.deflection[i].value() - bent,
                       v = state_.speed[i].value();
            next.deflection[i] = value::from_value(state_.deflection[i].value() + (m.away * q + m.onward * v));
            next.speed[i] = velocity::from_value(v + (m.back * q + m.loss * v));
            sum += next.deflection[i];
            good = good && finite(next.speed[i]);
        }
        if (!good || !finite(sum)) return out_.hold();
        for (std::size_t i = 0; i < Modes; ++i) {
            state_.deflection[i] = unless_died_out(next.deflection[i]);
            state_.speed[i] = unless_died_out(next.speed[i]);
        }
        return out_.keep(sum);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument force) noexcept {
        state next;
        value sum{};
        for (std::size_t i = 0; i < Modes; ++i) {
            next.deflection[i] = value::from_value(steps_[i].compliance * force.value());
            sum += next.deflection[i];
        }
        if (!finite(force, sum)) return out_.raise();
        state_ = next;
        out_.reset(sum);
    }

    /// From F[k] to the y that the same call returns: sampled, with the hold, one period ahead of the sample.
    std::complex<double> response(frequency f) const {
        const auto z = std::polar(1.0, 2 * std::numbers::pi * f.value() * period_.value());
        std::complex<double> sum = 0;
        for (const step& m : steps_) {
            const double a = 1 + detail::plain(m.away), b = detail::plain(m.onward), c = detail::plain(m.back),
                         d = 1 + detail::plain(m.loss);
            // (z - step) [q, v] = (1 - step) [bent, 0]
            const auto q = ((1 - a) * (z - d) - b * c) / ((z - a) * (z - d) - b * c);
            sum += detail::plain(m.compliance) * q;
        }
        return z * sum;
    }
    /// Of the machine itself, from a force that is not sampled: sum share_i/M / (s^2 + 2 zeta_i w_i s + w_i^2)
    /// [m/N].
    std::complex<double> continuous_response(frequency f) const {
        const std::complex<double> s{0, 2 * std::numbers::pi * f.value()};
        std::complex<double> sum = 0;
        for (const auto& m : given_.modes) {
            const double w = 2 * std::numbers::pi * detail::plain(m.centre);
            sum += detail::plain(m.share) / (s * s + 2 * detail::plain(m.damping) * w * s + w * w);
        }
        return sum / detail::plain(given_.mass);
    }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    struct step {
        Real away{}, onward{}, back{}, loss{},
            compliance{}; ///< away, loss: stay and keep minus one, so that float holds them
    };

    parameters given_;
    duration period_;
    std::array<step, Modes> steps_{};
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
