// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "../block/retuned.hpp"
#include "harmonic_design.hpp"
#include "nominal_plant.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// Cutting forces of known frequencies, from the position and the command applied, as a command: subtract their
/// sum.
///   dx/dt = v, dv/dt = -A v + B (u + sum q_i),  q_i[k+1] = cos(w_i T) q_i + sin(w_i T) r_i,  r_i[k+1] = cos r_i - sin q_i
///   x = p + L (encoder - p_x),  p the exact step of x for u and q held over the period;  d = sum q_i, turned by w_i lead
///   wire.disturbance = box.observer(measured, wire.command);   // z^-1: what brought the axis here
///   wire.command     = wire.wanted - wire.disturbance;
/// At these frequencies the loop's gain is infinite: a force there leaves nothing at the samples, whatever its
/// size and phase. (q is held like the command that cancels it, so it is the force as the samples show it, half
/// a period late.)
/// Source: [Jamaludin2008] Appendix D; L from the poles by residues, from noise by `dare` (docs/derivations).
/// Ports: position in, sum of the harmonics at the same sample out, in the unit of the command; the command
/// applied since the sample before is the second argument. A push in the direction of a positive command is
/// positive.
/// State: position, velocity, two numbers per harmonic in the unit of the command; `reset`: at rest at zero, no
/// force; `settle(x)`: at rest at x, no force.
/// `retune(next)`: other frequencies, plant or gains from the next step on; all states stay, so each harmonic
/// goes on from its place and size. Jump: what the new model turns and corrects differently in one period.
/// Range: 0 < w_i / 2 pi < half the sampling rate, all different; A > 0 with placed poles. The observer alone
/// is stable, checked here; with the loop around it and the axis' delay it need not be: equal poles below some
/// 110 1/s couple with the position loop of [Jamaludin2008], shifted ones do not. With many harmonics give
/// `lead` the delay and feed the command that much late.
/// A constant force is none of its states: leave that to the integral. The design is in double: a dual carries
/// derivatives of the signals, not of these parameters.
/// NaN and infinities in encoder or command: holds the last output, keeps the state, raises faulted().
/// Throws "harmonic_force_observer.<field> = ...: must ..." for period, plant, harmonics, design, and in the
/// names of `dare`.
/// Cost: 8 multiplications per harmonic and 6; 16 bytes of state per harmonic and 16. Unknown frequencies:
/// `disturbance_observer`; a period with many harmonics: a repetitive memory loop.
template <signal_tag Command, std::size_t Harmonics, class Design = placed_poles<Harmonics>,
          class Real = double>
requires(Harmonics > 0) && harmonic_design<Design, Command, Harmonics> class harmonic_force_observer {
public:
    using input = signal::position;
    using output = Command;
    using argument = quantity_of<signal::position, Real>;
    using value = quantity_of<Command, Real>;
    using velocity = quantity_of<signal::velocity, Real>;

    /// The axis as believed, the frequencies of the force, how the gains are found, and how late the axis acts.
    struct parameters {
        axis_model<Command> plant;                    ///< B > 0, A >= 0
        std::array<frequency, Harmonics> harmonics{}; ///< of the force; 0 < each < half the sampling rate
        Design design{};                              ///< `placed_poles` or `expected_noise`
        duration lead{}; ///< >= 0; the sum is that of this much later: the axis' delay
    };
    /// Motion of the axis, and each harmonic with its quarter-turn, in the unit of the command; at the last
    /// sample.
    struct state {
        argument position{};
        quadrant::quantity<si::velocity, Real> velocity{};
        std::array<value, Harmonics> in_phase{}, across{}; ///< q and r
    };
    static constexpr std::size_t order = 2 + 2 * Harmonics;
    static constexpr bool takes_last_applied =
        true; ///< a loop feeds the command that acted since the sample before

    harmonic_force_observer(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("harmonic_force_observer.period", period);
        require_positive<Real>("harmonic_force_observer.plant.gain", p.plant.gain);
        require_not_negative<Real>("harmonic_force_observer.plant.viscous_rate", p.plant.viscous_rate);
        require_not_negative<Real>("harmonic_force_observer.lead", p.lead);
        for (std::size_t i = 0; i < Harmonics; ++i) {
            require_below_nyquist("harmonic_force_observer.harmonics", p.harmonics[i], period);
            for (std::size_t j = 0; j < i; ++j)
                require(p.harmonics[i] != p.harmonics[j], "harmonic_force_observer.harmonics", p.harmonics[i],
                        "must not be there twice");
        }
        const double T = period.value(), thrust = p.plant.gain.value() * T * T;
        std::array<double, Harmonics> angles{};
        for (std::size_t i = 0; i < Harmonics; ++i) {
            angles[i] = 2 * std::numbers::pi * p.harmonics[i].value() * T;
            ahead_[2 + 2 * i] = std::cos(angles[i] * p.lead.value() / T);
            ahead_[3 + 2 * i] = std::sin(angles[i] * p.lead.value() / T);
        }
        model_ = detail::harmonic_model<Harmonics>::of(p.plant.viscous_rate.value() * T, angles);
        if constexpr (std::same_as<Design, expected_noise<Command>>) {
            require_positive<Real>("harmonic_force_observer.design.encoder", p.design.encoder);
            require_positive<Real>("harmonic_force_observer.design.drift", p.design.drift);
            const double wander = p.design.drift.value() * thrust / p.design.encoder.value();
            scaled_gain_ = model_.gain_for(wander * wander * T);
        } else {
            require(p.plant.viscous_rate.value() > 0, "harmonic_force_observer.plant.viscous_rate",
                    p.plant.viscous_rate, "must be above 0 for placed poles (or use expected_noise)");
            scaled_gain_ = model_.gain_for(p.design.poles, T);
        }
        radius_ = model_.radius(scaled_gain_);
        require(radius_ < 1 - 1e-7, "harmonic_force_observer.design", radius_,
                "leaves an eigenvalue at or outside the unit circle (in rounding, if the poles are many and "
                "equal)");

        const std::array unit{1.0, 1 / T, 1 / thrust}; // of position, velocity, command
        position_from_velocity_ = Real(model_.step[0][1] * T);
        position_from_command_ = Real(model_.from_command[0] * thrust);
        velocity_from_velocity_ = Real(model_.step[1][1]);
        velocity_from_command_ = Real(model_.from_command[1] * thrust / T);
        for (std::size_t i = 0; i < order; ++i) gain_[i] = Real(scaled_gain_[i] * unit[i < 2 ? i : 2]);
        for (std::size_t i = 0; i < Harmonics; ++i) {
            const std::size_t q = 2 + 2 * i;
            turn_[i] = {Real(model_.step[q][q]), Real(model_.step[q][q + 1])};
            lead_[i] = {Real(ahead_[q]), Real(ahead_[q + 1])};
        }
        thrust_ = thrust;
    }

    /// Sum of the harmonics now, from the encoder now and the command that acted since the sample before.
    value operator()(argument encoder, value applied = value()) noexcept {
        Real u = applied.value();
        for (const value& q : state_.in_phase) u += q.value();
        const Real v = state_.velocity.value();
        const Real px = state_.position.value() + (position_from_velocity_ * v + position_from_command_ * u);
        const Real pv = velocity_from_velocity_ * v + velocity_from_command_ * u;
        const Real off = encoder.value() - px;
        state next;
        Real sum{0};
        bool good = true, still = true;
        for (std::size_t i = 0; i < Harmonics; ++i) {
            const Real before = state_.in_phase[i].value(), aside = state_.across[i].value();
            const Real q = turn_[i].cosine * before + turn_[i].sine * aside + gain_[2 + 2 * i] * off;
            const Real r = turn_[i].cosine * aside - turn_[i].sine * before + gain_[3 + 2 * i] * off;
            next.in_phase[i] = value::from_value(q);
            next.across[i] = value::from_value(r);
            sum += lead_[i].cosine * q + lead_[i].sine * r;
            good = good && finite(q, r);
            still = still && died_out(q, r);
        }
        next.position = argument::from_value(px + gain_[0] * off);
        next.velocity = velocity::from_value(pv + gain_[1] * off);
        if (!good || !finite(next.position, next.velocity, sum)) return out_.hold();
        // All at once: a position is far smaller than the command that made it, and alone at zero it would move
        // the others.
        if (still && died_out(next.position, next.velocity)) next = {};
        state_ = next;
        innovation_ = argument::from_value(off);
        return out_.keep(value::from_value(sum));
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument position) noexcept {
        if (!finite(position)) return out_.raise();
        state_ = state{.position = position};
        innovation_ = argument();
        out_.reset();
    }

    void retune(const harmonic_force_observer& next) noexcept {
        detail::retuned(*this, next, next.period_ == period_, out_, state_, innovation_);
    }

    value harmonic(std::size_t i) const noexcept { return state_.in_phase[i]; } ///< one of them, now
    const argument& innovation() const noexcept { return innovation_; } ///< encoder minus what was expected
    double radius() const noexcept { return radius_; } ///< largest |eigenvalue| of the error's step, below 1
    /// From the position to the sum; and from the command, as the second argument, to the sum.
    std::complex<double> response(frequency f) const { return through(f, scaled_gain_) / thrust_; }
    std::complex<double> response_to_command(frequency f) const {
        auto b = model_.from_command;
        for (std::size_t i = 0; i < order; ++i) b[i] -= scaled_gain_[i] * model_.from_command[0];
        return through(f, b);
    }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    struct rotation {
        Real cosine, sine;
    };
    std::complex<double> through(frequency f, const column<order>& entering) const {
        using complex = std::complex<double>;
        const complex back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value());
        // x[k] = (1 - L C) F x[k-1] + what enters
        auto a = detail::identity<order, complex>();
        matrix<order, 1, complex> b{};
        for (std::size_t i = 0; i < order; ++i) {
            b[i][0] = entering[i];
            for (std::size_t j = 0; j < order; ++j)
                a[i][j] -= back * (model_.step[i][j] - scaled_gain_[i] * model_.step[0][j]);
        }
        const auto x = detail::solved(a, b);
        complex sum = 0;
        for (std::size_t i = 2; i < order; ++i) sum += ahead_[i] * x[i][0];
        return sum;
    }

    parameters given_;
    duration period_;
    Real position_from_velocity_{}, position_from_command_{}, velocity_from_velocity_{},
        velocity_from_command_{};
    std::array<rotation, Harmonics> turn_{}, lead_{};
    column<order, Real> gain_{};
    detail::harmonic_model<Harmonics> model_{}; ///< and the design, for response()
    column<order> scaled_gain_{}, ahead_{};
    double thrust_ = 1, radius_ = 0;
    state state_;
    argument innovation_{};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
