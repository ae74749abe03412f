// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "differences.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

namespace quadrant::inline v0 {

/// Coefficients of a sampled filter as bare numbers in SI, by rising power of z^-1; what `discretize.hpp`
/// gives.
template <std::size_t Order, class Number = double> struct discrete {
    std::array<Number, Order + 1> numerator{}, denominator{};
};

/// Any linear filter of fixed order, for what has no block of its own.
///   y = (b[0] + b[1] z^-1 + ... + b[n] z^-n) / (a[0] + a[1] z^-1 + ... + a[n] z^-n) x
/// Source: [Oppenheim2010] ch. 6, transposed direct form II, and [Middleton1990]: of integrators instead of
/// delays (`differences.hpp`), so that slow poles keep their digits; the states are in the unit of the output.
/// Ports: one scalar in, one scalar out of any signal; the numerator carries the unit Out/In.
/// State: n sums in the unit of the output, in float of two numbers each; `reset` leaves zero; what has died
/// out is zero; `retune(next)`: other coefficients from the next step on; each sum takes what it would differ
/// by, had the last input and output stood for ever. The output is off by (b0' - b0)(x[k] - x[k-1]) from what
/// it would have been, b0 = b[0]/a[0]; nothing changes, then or later, in steady state and with the same gain
/// there.
/// `settle(x)` the state of a constant x. With a pole at z = 1 (integrates()) no such state
/// exists: `settle(x, y)`, where the next step with x gives y; settle(x) then takes the last output for y.
/// Range: a[0] not zero. Poles outside the unit circle are allowed (a plant may have them); the output then
/// grows until it is no longer finite, and holds. Coefficients in z are doubles that hold (pole T)^n in their
/// last digits: below f T = 1e-4 give `differences` (from `bilinear_differences`), and from order 4 on prefer a
/// `series` of low orders.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "transfer_function.denominator[0] = 0: must not be zero", "transfer_function.numerator = ...: must be
/// finite".
/// Cost: 2 n + 1 multiplications, 3 n additions, 8 n bytes of state; in float 6 n additions. Of order one or
/// two: `lowpass`, `butterworth`, `notch`.
template <signal_tag In, signal_tag Out, std::size_t Order, class Real = double> class transfer_function {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using gain = gain_of<Out, In, Real>;

    /// Coefficients of both polynomials, the numerator's with their unit.
    struct parameters {
        std::array<gain_of<Out, In, number>, Order + 1> numerator{}; ///< by rising power of z^-1
        std::array<number, Order + 1> denominator{};                 ///< the same; denominator[0] not zero

        static parameters in_si(const discrete<Order, number>& d) {
            parameters p;
            for (std::size_t i = 0; i <= Order; ++i) {
                p.numerator[i] = gain_of<Out, In, number>::from_value(d.numerator[i]);
                p.denominator[i] = d.denominator[i];
            }
            return p;
        }
    };
    /// The integrators, in the unit of the output, and the last input.
    struct state {
        detail::integrators<value, Real, Order> s{};
        argument x{}; ///< for `retune`
    };

    transfer_function(const parameters& p, duration period)
        : transfer_function(p, {detail::about_one(in_si(p.numerator)), detail::about_one(p.denominator)},
                            period, 4 * std::numeric_limits<double>::epsilon()) {}
    /// By powers of 1/(z - 1): for poles so slow that coefficients in z have lost them.
    static transfer_function of(const differences<Order, number>& d, duration period) {
        return {parameters::in_si({detail::about_one(d.numerator, -1), detail::about_one(d.denominator, -1)}),
                d, period, 0};
    }

    value operator()(argument x) noexcept {
        const value y = Order == 0 ? value(b_[0] * x) : value(first().with(b_[0] * x));
        auto next = state_.s;
        Real sum = y.value();
        for (std::size_t i = 0; i < Order; ++i) {
            value part = b_[i + 1] * x - a_[i] * y;
            if (i + 1 < Order) part += state_.s[i + 1].high;
            next[i] = state_.s[i].plus(part).rested();
            sum += next[i].high.value();
        }
        const auto good = finite(sum);
        if (none(good)) return out_.hold();
        detail::rest_if_died_out(next, y, x);
        set_where(good, state_.s, next);
        set_where(good, state_.x, x);
        return out_.keep(good, y);
    }
    void reset() noexcept { settle(argument(), value()); }
    void settle(argument x) noexcept { settle(x, select(integrates_, out_.last(), value(standstill_ * x))); }
    void settle(argument x, value y) noexcept {
        detail::integrators<value, Real, Order> s{};
        Real sum = x.value() + y.value();
        for (std::size_t i = 0; i < Order; ++i) { // as if x and y had stood for ever; the first gives y
            s[i].high = i == 0 ? value(y - b_[0] * x) : value(a_[i - 1] * y - b_[i] * x);
            sum += s[i].high.value();
        }
        const auto good = finite(sum);
        set_where(good, state_.s, s);
        set_where(good, state_.x, x);
        out_.settle(good, y);
    }
    void retune(const transfer_function& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        auto s = state_.s;
        for (std::size_t i = 0; i < Order; ++i) {
            s[i].high -= (next.b_[i] - b_[i]) * state_.x;
            if (i > 0) s[i].high += (next.a_[i - 1] - a_[i - 1]) * out_.last();
        }
        for (std::size_t i = 0; i < Order; ++i)
            if (!all(finite(s[i].high))) return out_.raise();
        const argument x = state_.x;
        const auto out = out_;
        *this = next;
        state_.s = s;
        state_.x = x;
        out_ = out;
    }

    std::complex<double> response(frequency f) const {
        const double angle = 2 * std::numbers::pi * f.value() * period_.value();
        std::array<double, Order + 1> under{1};
        for (std::size_t i = 0; i < Order; ++i) under[i + 1] = detail::plain(a_[i]);
        return detail::in_differences(b_, angle) / detail::in_differences(under, angle);
    }
    mask_of<Real> integrates() const noexcept { return integrates_; } ///< has a pole at z = 1
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static std::array<number, Order + 1> in_si(const std::array<gain_of<Out, In, number>, Order + 1>& p) {
        std::array<number, Order + 1> bare;
        for (std::size_t i = 0; i <= Order; ++i) bare[i] = p[i].value();
        return bare;
    }
    transfer_function(const parameters& p, const differences<Order, number>& d, duration period,
                      double rounding)
        : given_(p), period_(period) {
        require_positive<Real>("transfer_function.period", period);
        for (std::size_t i = 0; i <= Order; ++i) {
            require_finite<Real>("transfer_function.numerator", p.numerator[i]);
            require_finite<Real>("transfer_function.denominator", p.denominator[i]);
        }
        const number a0 = p.denominator[0];
        require_lanes([&](std::size_t i) { return detail::plain(lane(a0, i)) != 0; },
                      "transfer_function.denominator[0]", a0, "must not be zero");
        number size_of_a(0);
        for (std::size_t i = 0; i <= Order; ++i) {
            b_[i] = gain::from_value(Real(d.numerator[i] / a0));
            require_coefficients<Real>("transfer_function.denominator[0]", a0, d.numerator[i] / a0,
                                       d.denominator[i] / a0);
            if (i > 0) a_[i - 1] = Real(d.denominator[i] / a0);
            size_of_a += absolute(p.denominator[i]);
        }
        // Closer to z = 1 than coefficients in z can resolve: the sum is nothing but their rounding.
        integrates_ = less_equal(absolute(d.denominator[Order]), number(rounding) * size_of_a);
        set_where(!integrates_, standstill_, gain::from_value(Real(d.numerator[Order] / d.denominator[Order])));
    }
    decltype(auto) first() const noexcept { return state_.s[0]; }

    parameters given_;
    duration period_;
    std::array<gain, Order + 1> b_{}; ///< by rising power of 1/D, as a_
    std::array<Real, Order> a_{};     ///< from 1/D on
    mask_of<Real> integrates_{};
    gain standstill_{};
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
