// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../filter/discretize.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

/// Q of a disturbance observer, and the polynomials that bring Q and Q/Gn into sampled form.
namespace quadrant::inline v0 {

namespace detail {

template <std::size_t A, std::size_t B, class Number>
constexpr std::array<Number, A + B - 1> product(const std::array<Number, A>& a,
                                                const std::array<Number, B>& b) {
    std::array<Number, A + B - 1> c{};
    for (std::size_t i = 0; i < A; ++i)
        for (std::size_t j = 0; j < B; ++j) c[i + j] += a[i] * b[j];
    return c;
}

/// (s + wc)^n by rising powers: its first m + 1 coefficients are the numerator of Q, eq. (4.7).
template <std::size_t Order, class Number> std::array<Number, Order + 1> binomial(const Number& wc) {
    std::array<Number, Order + 1> p{};
    p[0] = 1;
    for (std::size_t k = 0; k < Order; ++k)
        for (std::size_t i = k + 2; i-- > 0;) p[i] = wc * p[i] + (i > 0 ? p[i - 1] : Number(0));
    return p;
}

/// sum c_i x^i.
template <std::size_t Size, class Coefficient>
std::complex<double> polynomial(const std::array<Coefficient, Size>& c, std::complex<double> x) {
    std::complex<double> y = 0;
    for (std::size_t i = Size; i-- > 0;) y = y * x + plain(c[i]);
    return y;
}

/// All roots of sum c_i s^i left of the imaginary axis: inside the unit circle after the bilinear form, by
/// Schur and Cohn's step-down. Any rate of that form would do; one of the polynomial's own keeps its digits.
template <std::size_t Size, class Number> bool roots_left_of_axis(const std::array<Number, Size>& c) {
    constexpr std::size_t order = Size - 1;
    const double rate = order == 0 || plain(c[0]) == 0
                            ? 1
                            : std::pow(std::abs(plain(c[0]) / plain(c[order])), 1.0 / double(order));
    std::array<double, Size> a{};
    for (std::size_t i = 0; i < Size; ++i) {
        std::array<double, Size> p{1}; // (1 - z^-1)^i (1 + z^-1)^(order - i)
        for (std::size_t j = 0; j < order; ++j) multiply(p, j < i ? -1.0 : 1.0);
        const double weight = plain(c[i]) * std::pow(rate, double(i) - double(order));
        for (std::size_t j = 0; j < Size; ++j) a[j] += weight * p[j];
    }
    for (std::size_t n = order; n > 0; --n) {
        const double k = a[n] / a[0];
        if (!(std::abs(k) < 1)) return false;
        const auto old = a;
        for (std::size_t i = 0; i < n; ++i) a[i] = old[i] - k * old[n - i];
    }
    return true;
}

} // namespace detail

/// The low-pass of a disturbance observer: n equal poles at wc = 2 pi corner, the first m + 1 terms of the
/// denominator on top, so that 1 - Q has m + 1 zeros at s = 0 (m = 0 forgets a constant disturbance, m = 1 a
/// ramp). [Jamaludin2008] (4.6), (4.7).
template <std::size_t Order, std::size_t NumeratorOrder, class Number>
continuous<Order, Number> q_filter(const quantity<hertz_unit, Number>& corner) {
    static_assert(NumeratorOrder < Order, "Q must be a low-pass: its numerator needs a lower order");
    continuous<Order, Number> q{.denominator =
                                    detail::binomial<Order>(Number(2 * std::numbers::pi * corner.value()))};
    for (std::size_t i = 0; i <= NumeratorOrder; ++i) q.numerator[i] = q.denominator[i];
    return q;
}

/// Q is a low-pass and Q/Gn does not differentiate: m < n and n - m >= relative degree.
template <std::size_t Order, std::size_t NumeratorOrder, std::size_t RelativeDegree>
concept q_is_not_below_the_relative_degree = (NumeratorOrder < Order) &&
                                             (Order - NumeratorOrder >= RelativeDegree);

} // namespace quadrant::inline v0
