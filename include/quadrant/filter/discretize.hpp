// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "differences.hpp"
#include "pole_mapping.hpp"
#include "transfer_function.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

/// From a transfer function in s to one in z^-1, for `transfer_function`. Not a step: runs once, may throw.
/// Coefficients go by rising power in both, so that those not written are zero: H(s) = 1 / (s^2 + 3 s + 2) is
/// `continuous<2>{{1}, {2, 3, 1}}`. (scipy and MATLAB write falling powers of s.) Bare numbers in SI, s in
/// rad/s.
///   zero_order_hold  exact for an input held over each period: a plant behind a DAC
///   bilinear         s = 2/T (z-1)/(z+1): filters; with a frequency, exact there (pre-warp)
///   matched          poles and zeros by z = exp(s T): keeps resonances in place, no pre-warp needed
/// Source: [Franklin1998] ch. 6 (numerical integration, zero-pole matching, hold equivalents).
/// Range: poles and zeros at s = 0 (integrators, differentiators) included; 1e-13 of the largest coefficient
/// for orders up to 6 and abs(pole) T up to 30 (against 80 digits; scipy.signal.cont2discrete loses the
/// numerator of slow poles from order 2 on). Table: docs/blocks/discretize.md.
/// Throws "discretize.denominator = 0: highest coefficient must not be zero", and "must be finite", "must be
/// finite and above 0" for coefficients and period.
namespace quadrant::inline v0 {

/// numerator / denominator in s, coefficients by rising power.
template <std::size_t Order, class Number = double> struct continuous {
    std::array<Number, Order + 1> numerator{}, denominator{};
};

namespace detail {
template <std::size_t Order, class Number> void check(const continuous<Order, Number>& c, duration period) {
    static_assert(Order > 0, "a plain gain needs no discretization");
    require_positive("discretize.period", period);
    for (const auto& x : c.numerator) require_finite("discretize.numerator", x);
    for (const auto& x : c.denominator) require_finite("discretize.denominator", x);
    require(plain(c.denominator[Order]) != 0, "discretize.denominator", c.denominator[Order],
            "highest coefficient must not be zero (coefficients go by rising power)");
}

} // namespace detail

/// Exact for an input that stands still between samples: what a controller sees of a plant behind a DAC.
template <std::size_t Order, class Number>
discrete<Order, Number> zero_order_hold(const continuous<Order, Number>& c, duration period) {
    detail::check(c, period);
    constexpr std::size_t N = Order;
    const double T = period.value(), rate = detail::scale(c.denominator, N, T);
    const Number top = c.denominator[N], direct = c.numerator[N] / top;
    // State space in controllable form, states in units of `rate`; the last column of the enlarged matrix is
    // the input.
    detail::square<N + 1, Number> a = detail::companion<N + 1>(c.denominator, N, rate, T);
    std::array<Number, N + 1> out{};
    for (std::size_t i = 0; i < N; ++i)
        out[i] = (c.numerator[i] / top - direct * (c.denominator[i] / top)) * std::pow(rate, -double(N - i));
    if constexpr (N > 0) a[N - 1][N] = rate * T;
    const auto e = detail::exponential(a);
    // Impulse response h[0..N], then numerator = denominator * h.
    std::array<Number, N + 1> h{}, x{}, next{};
    for (std::size_t i = 0; i < N; ++i) x[i] = e[i][N];
    h[0] = direct;
    for (std::size_t k = 1; k <= N; ++k) {
        for (std::size_t i = 0; i < N; ++i) h[k] += out[i] * x[i];
        next = {};
        for (std::size_t i = 0; i < N; ++i)
            for (std::size_t j = 0; j < N; ++j) next[i] += e[i][j] * x[j];
        x = next;
    }
    discrete<Order, Number> d{.denominator = detail::mapped(c.denominator, T)};
    for (std::size_t k = 0; k <= N; ++k)
        for (std::size_t i = 0; i <= k; ++i) d.numerator[k] += d.denominator[i] * h[k - i];
    return d;
}

namespace detail {
template <std::size_t Order, class Number>
discrete<Order, Number> bilinear_at(const continuous<Order, Number>& c, double k) { // s = k (z-1)/(z+1)
    discrete<Order, Number> d;
    for (std::size_t i = 0; i <= Order; ++i) {
        std::array<Number, Order + 1> p{}; // (1 - z^-1)^i (1 + z^-1)^(Order - i)
        p[0] = 1;
        for (std::size_t j = 0; j < Order; ++j) multiply(p, j < i ? -1.0 : 1.0);
        const double power = std::pow(k, double(i) - double(Order)); // all times k^-Order: no overflow
        for (std::size_t j = 0; j <= Order; ++j) {
            d.numerator[j] += c.numerator[i] * power * p[j];
            d.denominator[j] += c.denominator[i] * power * p[j];
        }
    }
    const Number a0 = d.denominator[0];
    require(plain(a0) != 0, "discretize.denominator", a0, "has a pole that the bilinear form puts at infinity");
    for (std::size_t j = 0; j <= Order; ++j) {
        d.numerator[j] = d.numerator[j] / a0;
        d.denominator[j] = d.denominator[j] / a0;
    }
    return d;
}
} // namespace detail

/// s = 2/T (z-1)/(z+1): the same response, at frequencies compressed towards half the sampling rate.
template <std::size_t Order, class Number>
discrete<Order, Number> bilinear(const continuous<Order, Number>& c, duration period) {
    detail::check(c, period);
    return detail::bilinear_at(c, 2 / period.value());
}

/// The same, stretched so that the response at `exact` is that of the continuous filter.
template <std::size_t Order, class Number>
discrete<Order, Number> bilinear(const continuous<Order, Number>& c, duration period, frequency exact) {
    detail::check(c, period);
    require_below_nyquist("discretize.exact", exact, period);
    const double w = 2 * std::numbers::pi * exact.value();
    return detail::bilinear_at(c, w / std::tan(w * period.value() / 2));
}

/// The same in powers of 1/(z - 1), for `transfer_function::of`: poles keep their digits, however slow.
template <std::size_t Order, class Number>
differences<Order, Number> bilinear_differences(const continuous<Order, Number>& c, duration period) {
    detail::check(c, period);
    const double k = 2 / period.value();
    return {detail::bilinear_differences<Order>(c.numerator, k, false),
            detail::bilinear_differences<Order>(c.denominator, k, false)};
}

/// Poles and zeros by z = exp(s T); zeros at infinity go to z = -1 but for one, which leaves one period of
/// delay; the gain at standstill is kept (with poles or zeros at s = 0: that of the slowest term, s taken for
/// (z-1)/T).
template <std::size_t Order, class Number>
discrete<Order, Number> matched(const continuous<Order, Number>& c, duration period) {
    detail::check(c, period);
    const double T = period.value();
    const std::size_t m = detail::degree(c.numerator);
    discrete<Order, Number> d{.denominator = detail::mapped(c.denominator, T)};
    if (detail::plain(c.numerator[m]) == 0) return d; // no numerator: zero
    auto q = detail::mapped(c.numerator, T);
    for (std::size_t i = m; i + 1 < Order; ++i) detail::multiply(q, 1.0);
    if (m < Order) { // the one that stays at infinity
        for (std::size_t i = Order; i > 0; --i) q[i] = q[i - 1];
        q[0] = 0;
    }
    // Value of p / (1 - z^-1)^roots at z = 1: divide by repeated summing, then add up.
    const auto at_one = [](std::array<Number, Order + 1> p, std::size_t roots) {
        for (; roots > 0; --roots)
            for (std::size_t i = 1; i <= Order; ++i) p[i] += p[i - 1];
        Number sum(0);
        for (const auto& x : p) sum += x;
        return sum;
    };
    const std::size_t over = detail::roots_at_zero(c.numerator), under = detail::roots_at_zero(c.denominator);
    const Number wanted = c.numerator[over] / c.denominator[under] * std::pow(T, double(under) - double(over));
    const Number gain = wanted * at_one(d.denominator, under) / at_one(q, over);
    for (std::size_t i = 0; i <= Order; ++i) d.numerator[i] = gain * q[i];
    return d;
}

} // namespace quadrant::inline v0
