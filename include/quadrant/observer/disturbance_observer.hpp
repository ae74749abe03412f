// SPDX-License-Identifier: BSL-1.0
// Long: one block, and how far its filter may reach.
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../filter/differences.hpp"
#include "../filter/slowest.hpp"
#include "nominal_plant.hpp"
#include "q_filter.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// What pushes the axis beside the command, as a command: subtract it and the axis behaves as its nominal
/// plant.
///   d = Q (Gn^-1 z - u),   u = what is applied;   Q(s) = sum_{i=0..m} q_i s^i / (s + wc)^n,   wc = 2 pi corner
/// Q and Q/Gn are bilinear with one denominator and share their state. Both pass straight through, so that d
/// depends on the u
/// that depends on d: the step solves u = wanted - d exactly instead of taking last cycle's u
/// (docs/derivations).
///   wire.disturbance = box.observer(measured, wire.wanted);        // solved together with the next line
///   wire.command     = wire.wanted - wire.disturbance;
///   wire.applied     = box.amplifier(wire.command + wire.friction);
///   box.observer.applied(wire.applied - wire.friction);            // or friction is compensated twice
/// Clipping by a limiter in between is part of the solution. The last line may be left out where nothing clips.
/// Source: [Jamaludin2008] eq. (4.1) to (4.20).
/// Ports: measured z; wanted command in, disturbance out, both in the unit of the command; a push in the
/// direction of a positive command is positive.
/// State: n + zeros of the plant integrators in the unit of the command (`differences.hpp`), last z, last u;
/// `reset`: at rest at zero, nothing pushes; `settle(z)`: at rest at z, nothing pushes; `settle(z, d)`: at rest
/// at z while -d is applied against d (a following step with wanted = 0 gives d). A plant that does not
/// integrate needs the wanted command z/Gn(0) to stay there. `retune(next)`: another corner, another plant from
/// the next step on; nothing changes at rest and in even motion, else the coming d is off by |p0 (x[k] -
/// x[k-1]) - q0 (u[k] - u[k-1])| / (1 - q0'), x: z or its difference, p0 and q0: what the first coefficients of
/// Q/Gn and Q change, q0' the new one. `shift(by)`: the frame of positions moves.
/// Range: 0 < corner < half the sampling rate (in float from 3e-7 of it on, in double from 6e-16); n - m not
/// below the relative degree of the plant, else it does not compile; zeros of the plant left of the axis. |Q|
/// is -3 dB below the corner (n = 2, m = 0: at 0.644 of it). Gn carries no delay; an inverse-model feedforward
/// must use the same Gn. What has died out is zero.
/// NaN and infinities: holds the last output, keeps the state, raises faulted(); an `applied` that follows
/// changes nothing. Throws "disturbance_observer.<field> = ...: must ..." for period, corner, plant.numerator,
/// plant.denominator.
/// Cost: 3 (n + zeros) + 3 multiplications, 4 (n + zeros) additions; in float 7. From an acceleration:
/// `ferraris_force_estimator`; noisy encoder: `kalman`.
template <signal_tag Command, signal_tag Measured = signal::position, std::size_t Order = 2,
          std::size_t NumeratorOrder = 0, std::size_t PlantOrder = 2, std::size_t PlantZeros = 0,
          class Real = double>
requires q_is_not_below_the_relative_degree<Order, NumeratorOrder, PlantOrder - PlantZeros>
class disturbance_observer {
public:
    using input = Measured;
    using output = Command;
    using argument = quantity_of<Measured, Real>;
    using value = quantity_of<Command, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// How fast the estimate follows, and the axis it is made against.
    struct parameters {
        quantity<hertz_unit, number> corner; ///< wc / (2 pi); 0 < corner < half the sampling rate
        nominal_plant<PlantOrder, PlantZeros, number> plant{}; ///< or an `axis_model`
    };
    static constexpr std::size_t order = Order + PlantZeros; ///< of the common denominator
    /// That of Q, in the unit of the command, and the last measurement and command that entered it.
    struct state {
        detail::integrators<value, Real, order> s{};
        argument measured{};
        argument moved{}; ///< what entered: its last difference, where the plant integrates
        value command{};  ///< that was taken for applied
    };

    disturbance_observer(const parameters& p, duration period) : given_(checked(p, period)), period_(period) {
        const auto q = q_filter<Order, NumeratorOrder>(p.corner);
        integrates_ = equal(p.plant.denominator[0], number(0));
        const double k = 2 / period.value();
        std::array<number, NumeratorOrder + 1> top{};
        for (std::size_t i = 0; i <= NumeratorOrder; ++i) top[i] = q.numerator[i];
        using detail::bilinear_differences;
        const auto under =
            bilinear_differences<order>(detail::product(q.denominator, p.plant.numerator), k, false);
        const auto over = bilinear_differences<order>(detail::product(top, p.plant.numerator), k, false);
        const auto back = detail::product(top, p.plant.denominator);
        auto inverse = bilinear_differences<order>(back, k, all(integrates_));
        if (any(integrates_) && !all(integrates_))
            set_where(integrates_, inverse, bilinear_differences<order>(back, k, true));
        require_lanes([&](std::size_t i) { return detail::roots_left_of_axis(lane(p.plant.numerator, i)); },
                      "disturbance_observer.plant.numerator", p.plant.numerator[0],
                      "has a zero on or right of the imaginary axis: 1/Gn would be unstable");
        for (std::size_t i = 0; i <= order; ++i) {
            from_measured_[i] = gain_of<Command, Measured, Real>::from_value(Real(inverse[i] / under[0]));
            from_command_[i] = Real(over[i] / under[0]);
            if (i > 0) feedback_[i - 1] = Real(under[i] / under[0]);
        }
        for (std::size_t i = 0; i <= order; ++i)
            require_coefficients<Real>("disturbance_observer.plant.denominator", p.plant.denominator[0],
                                       inverse[i] / under[0], over[i] / under[0], under[i] / under[0]);
        for (std::size_t i = 0; i < order; ++i)
            from_applied_[i] = feedback_[i] * from_command_[0] - from_command_[i + 1];
        solved_ = Real(1) / (Real(1) - from_command_[0]);
        standstill_ = select(
            integrates_, gain_of<Command, Measured, Real>(),
            gain_of<Command, Measured, Real>::from_value(Real(p.plant.denominator[0] / p.plant.numerator[0])));
    }

    /// The disturbance, on the understanding that wanted - disturbance is applied.
    value operator()(argument measured, value wanted = value()) noexcept {
        const argument x = select(integrates_, argument(measured - state_.measured), measured);
        const value free = state_.s[0].with(from_measured_[0] * x); // d = free - q0 u and u = wanted - d
        const value d = solved_ * (free - from_command_[0] * wanted), u = wanted - d;
        auto next = state_.s;
        Real sum = bare(measured, d, u);
        for (std::size_t i = 0; i < order; ++i) {
            value part = from_measured_[i + 1] * x - from_command_[i + 1] * u - feedback_[i] * d;
            if (i + 1 < order) part += state_.s[i + 1].high;
            next[i] = state_.s[i].plus(part).rested();
            sum += next[i].high.value();
        }
        const auto good = finite(sum);
        stepped_ = good;
        if (none(good)) return out_.hold();
        detail::rest_if_died_out(next, d, u, x);
        set_where(good, state_.s, next);
        set_where(good, state_.measured, measured);
        set_where(good, state_.moved, x);
        set_where(good, state_.command, u);
        return out_.keep(good, d);
    }
    /// What was really applied of the last command, without what was added after it (friction feedforward).
    void applied(value u) noexcept {
        if (none(stepped_)) return; // no sample was taken
        const value more = u - state_.command, d = out_.last() - from_command_[0] * more;
        auto s = state_.s;
        Real sum = bare(u, d);
        for (std::size_t i = 0; i < order; ++i) {
            s[i] = s[i].plus(from_applied_[i] * more);
            sum += s[i].high.value();
        }
        const auto good = finite(sum);
        const auto taken = both(stepped_, good);
        if (none(taken)) return out_.raise(stepped_);
        set_where(taken, state_.s, s);
        set_where(taken, state_.command, u);
        out_.keep(select(taken, d, out_.last()));
        out_.raise(both(stepped_, !good));
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument measured) noexcept { settle(measured, value()); }
    void settle(argument measured, value d) noexcept {
        const argument x = select(integrates_, argument(), measured);
        const value u = standstill_ * measured - d;
        const auto s = standing(x, u, d);
        Real sum = bare(measured, d);
        for (const auto& each : s) sum += each.high.value();
        const auto good = finite(sum);
        set_where(good, state_.s, s);
        set_where(good, state_.measured, measured);
        set_where(good, state_.moved, x);
        set_where(good, state_.command, u);
        if constexpr (!std::is_empty_v<decltype(stepped_)>) set_where(good, stepped_, mask_of<Real>());
        out_.settle(good, d);
    }
    void retune(const disturbance_observer& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        const value d = out_.last();
        const auto before = standing(state_.moved, state_.command, d),
                   after = next.standing(state_.moved, state_.command, d);
        auto s = state_.s;
        Real sum(0);
        for (std::size_t i = 0; i < order; ++i) {
            s[i] = s[i].plus(after[i].high - before[i].high);
            sum += s[i].high.value();
        }
        const auto good = both(finite(sum), select(integrates_, next.integrates_, !next.integrates_));
        if (none(good)) return out_.raise();
        given_ = next.given_;
        set_where(good, from_measured_, next.from_measured_);
        set_where(good, from_command_, next.from_command_);
        set_where(good, feedback_, next.feedback_);
        set_where(good, from_applied_, next.from_applied_);
        set_where(good, standstill_, next.standstill_);
        set_where(good, solved_, next.solved_);
        set_where(good, state_.s, s);
        out_.raise(!good);
    }
    void shift(argument by) noexcept { ///< where the plant integrates; else a position of its own holds it
        const auto good = both(finite(by), integrates_);
        set_where(good, state_.measured, state_.measured + by);
        out_.raise(!good);
    }

    /// From the measured signal to the disturbance with wanted = 0, the loop through the command closed: (Q/Gn)
    /// / (1 - Q).
    std::complex<double> response(frequency f) const { return inverse(f) / (1.0 - q(f)); }
    /// Q as it runs.
    std::complex<double> q(frequency f) const {
        return detail::in_differences(from_command_, angle(f)) / under(f);
    }
    /// Q/Gn as it runs.
    std::complex<double> inverse(frequency f) const {
        const double a = angle(f);
        const std::complex<double> difference =
            std::complex<double>(0, 2 * std::sin(a / 2)) * std::polar(1.0, -a / 2); // 1 - z^-1
        return detail::in_differences(from_measured_, a) / under(f) * (all(integrates_) ? difference : 1.0);
    }
    /// Gn(j w), continuous.
    std::complex<double> nominal(frequency f) const {
        const std::complex<double> s(0, 2 * std::numbers::pi * f.value());
        return detail::polynomial(given_.plant.numerator, s) / detail::polynomial(given_.plant.denominator, s);
    }
    value disturbance() const noexcept { return out_.last(); } ///< with what was applied, if that has been told
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("disturbance_observer.period", period);
        require_below_nyquist("disturbance_observer.corner", p.corner, period);
        require_held<Real>("disturbance_observer.corner", p.corner, period);
        for (const auto& c : p.plant.numerator) require_finite<Real>("disturbance_observer.plant.numerator", c);
        for (const auto& c : p.plant.denominator)
            require_finite<Real>("disturbance_observer.plant.denominator", c);
        const auto not_zero = [](const number& c) {
            return [&c](std::size_t i) { return detail::plain(lane(c, i)) != 0; };
        };
        const number &over = p.plant.numerator.back(), &under = p.plant.denominator.back();
        require_lanes(not_zero(over), "disturbance_observer.plant.numerator", over,
                      "highest coefficient must not be zero");
        require_lanes(not_zero(under), "disturbance_observer.plant.denominator", under,
                      "highest coefficient must not be zero");
        return p;
    }
    /// Their sum without units, for `finite`.
    template <class... Values> static Real bare(const Values&... values) noexcept {
        return (values.value() + ...);
    }
    /// The state as if these had stood for ever.
    detail::integrators<value, Real, order> standing(argument x, value u, value d) const noexcept {
        detail::integrators<value, Real, order> s{};
        s[0].high = d - from_measured_[0] * x + from_command_[0] * u;
        for (std::size_t i = 1; i < order; ++i)
            s[i].high = feedback_[i - 1] * d - from_measured_[i] * x + from_command_[i] * u;
        return s;
    }
    double angle(frequency f) const { return 2 * std::numbers::pi * f.value() * period_.value(); }
    std::complex<double> under(frequency f) const {
        std::array<double, order + 1> p{1};
        for (std::size_t i = 0; i < order; ++i) p[i + 1] = detail::plain(feedback_[i]);
        return detail::in_differences(p, angle(f));
    }

    parameters given_;
    duration period_;
    mask_of<Real> integrates_ = mask_of<Real>(
        true); ///< the plant does: z enters by its differences, so that a constant gives exactly zero
    std::array<gain_of<Command, Measured, Real>, order + 1>
        from_measured_{}; ///< numerator of Q/Gn, by rising power of 1/D (differences.hpp)
    std::array<Real, order + 1> from_command_{};    ///< numerator of Q; [0] passes straight through
    std::array<Real, order> feedback_{};            ///< denominator from 1/D on
    std::array<Real, order> from_applied_{};        ///< what a command beyond the one taken for applied changes
    gain_of<Command, Measured, Real> standstill_{}; ///< 1 / Gn(0)
    Real solved_{1};
    state state_;
    decltype(finite(Real())) stepped_{};
    held_output<value> out_;
};

/// How far an observer is from what its unmodelled part allows: |Q| <= 1/|Delta|, Delta = (G - Gn)/Gn,
/// [Jamaludin2008] (4.19).
struct robust_stability {
    double worst = 0; ///< largest |Q Delta|; sufficient for stability: below 1
    frequency at{};   ///< where
    bool holds() const noexcept { return worst < 1; }
};

/// Over `points` frequencies, evenly spaced in their logarithm; `plant(frequency)` gives the measured FRF (or a
/// model with its delay) as std::complex<double>, in the units of the nominal plant.
template <class Observer, class Frf>
robust_stability robustness(const Observer& observer, Frf&& plant, frequency from, frequency to,
                            std::size_t points = 1000) {
    require_positive("robustness.from", from);
    require(detail::is_finite(to.value()) && to > from, "robustness.to", to,
            "must be finite and above from (" + detail::shortest(from) + ")");
    require(points >= 2, "robustness.points", double(points), "must be at least 2");
    robust_stability result;
    for (std::size_t i = 0; i < points; ++i) {
        const frequency f = from * std::pow(to.value() / from.value(), double(i) / double(points - 1));
        const std::complex<double> nominal = observer.nominal(f), delta = (plant(f) - nominal) / nominal;
        const double size = std::abs(observer.q(f) * delta);
        require_finite("robustness.plant", size);
        if (size > result.worst) result = {size, f};
    }
    return result;
}

} // namespace quadrant::inline v0
