// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../block/retuned.hpp"
#include "../observer/nominal_plant.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// The command that moves the nominal plant as the reference asks, from positions alone: for a trajectory that
/// does not give its derivatives. Linear-phase differences, so that every order of them is late by the same
/// time.
///   u = (d0 r + d1 r' + ... + dN r^(N)) / n0,   d/dt = (1 - z^-1) / T, smoothed by ((1 + z^-1) / 2)^(N - order)
/// that is s = 2 (z - 1) / (T (z + 1)) times ((1 + z^-1) / 2)^N. For B / (s (s + A)): second difference, and
/// the difference over two samples.
/// Source: [Jamaludin2008] eq. (2.2), inverse-model feedforward; [Oppenheim2010] linear-phase FIR.
/// Ports: reference in, command out. Late by N/2 periods exactly, at all frequencies (order 2: one period):
/// delay the loop's reference by as much (`delay_line`), and by the plant's delay.
/// State: the last N references; `reset` leaves zeros, so a first sample reads as a jump: `settle(r0)` first.
/// `retune(next)`: another plant from the next step on; jump: that of the weights times the differences.
/// Range: any plant of order 1 ... 4 without zeros; n0 and dN not zero. Gain of the difference of order i at f:
/// sinc^i(f T) cos^(N-i)(pi f T) of the derivative. A count q of the reference shows as up to 2 q d2 / (n0 T^2)
/// (order 2). A plant with zeros has no inverse that ends: its zeros would have to be poles here.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "sampled_inverse_model.numerator = ...: must ...", "...denominator = ...: must ..." and for the
/// period.
/// Cost: at most (N + 1)^2 multiplications, 8 N bytes. With derivatives from the trajectory, not late:
/// `inverse_model`.
template <signal_tag Command, std::size_t Order = 2, signal_tag In = signal::position, class Real = double>
requires(Order >= 1 && Order <= 4) class sampled_inverse_model {
public:
    using input = In;
    using output = Command;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Command, Real>;
    using number = parameter_real<Real>; ///< of parameters

    using parameters = nominal_plant<Order, 0, number>; ///< from Command to In; an `axis_model` converts
    /// The references that the differences are taken of.
    struct state {
        std::array<argument, Order> r{}; ///< newest first
    };

    sampled_inverse_model(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("sampled_inverse_model.period", period);
        require_finite<Real>("sampled_inverse_model.numerator", p.numerator[0]);
        require(p.numerator[0] != number(0), "sampled_inverse_model.numerator", p.numerator[0],
                "must be finite and not 0");
        number per_period = number(1) / p.numerator[0];
        for (std::size_t i = 0; i <= Order; ++i) {
            require_finite<Real>("sampled_inverse_model.denominator", p.denominator[i]);
            require_coefficients<Real>("sampled_inverse_model.denominator", p.denominator[i],
                                       p.denominator[i] * per_period, per_period);
            weight_[i] = Real(p.denominator[i] * per_period);
            per_period = per_period / number(period.value());
        }
        require(p.denominator[Order] != number(0), "sampled_inverse_model.denominator", p.denominator[Order],
                "must not be 0 at the highest power");
    }

    value operator()(argument x) noexcept {
        const value u = at(x);
        if (!finite(x, u)) return out_.hold();
        for (std::size_t i = Order - 1; i > 0; --i) state_.r[i] = state_.r[i - 1];
        state_.r[0] = x;
        return out_.keep(u);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument x) noexcept {
        const value u = value::from_value(weight_[0] * x.value());
        if (!finite(x, u)) return out_.raise();
        state_.r.fill(x);
        out_.reset(u);
    }

    void retune(const sampled_inverse_model& next) noexcept {
        detail::retuned(*this, next, next.period_ == period_, out_, state_);
    }

    std::complex<double> response(frequency f) const {
        const double half = std::numbers::pi * f.value() * period_.value();
        const std::complex<double> difference(0, 2 * std::sin(half));
        std::complex<double> sum = 0, power = 1;
        for (std::size_t i = 0; i <= Order; ++i) {
            sum += power * detail::plain(weight_[i]) * std::pow(std::cos(half), double(Order - i));
            power *= difference;
        }
        return sum * std::polar(1.0, -half * double(Order));
    }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    /// Differences first, weights after: a reference that stands still gives no rounding.
    value at(argument x) const noexcept {
        std::array<Real, Order + 1> row{}; // differences of order i, newest first
        row[0] = x.value();
        for (std::size_t j = 0; j < Order; ++j) row[j + 1] = state_.r[j].value();
        Real sum{};
        for (std::size_t i = 0; i <= Order; ++i) {
            auto mean = row; // averaged in pairs until one is left
            for (std::size_t left = Order - i; left > 0; --left)
                for (std::size_t j = 0; j < left; ++j) mean[j] = Real(0.5) * (mean[j] + mean[j + 1]);
            sum += weight_[i] * mean[0];
            for (std::size_t j = 0; j + i < Order; ++j) row[j] -= row[j + 1];
        }
        return value::from_value(sum);
    }

    parameters given_;
    duration period_;
    std::array<Real, Order + 1> weight_{}; ///< d_i / (n0 T^i)
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
