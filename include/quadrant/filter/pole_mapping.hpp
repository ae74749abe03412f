// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// The arithmetic of discretize.hpp: a polynomial's roots carried from s to z = exp(s T) by the matrix
/// exponential of its companion matrix. Small fixed-size matrices, any number type, no Eigen.
namespace quadrant::inline v0 {

namespace detail {

template <std::size_t N, class Number> using square = std::array<std::array<Number, N>, N>;

template <std::size_t N, class Number>
constexpr square<N, Number> times(const square<N, Number>& a, const square<N, Number>& b) {
    square<N, Number> c{};
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t k = 0; k < N; ++k)
            for (std::size_t j = 0; j < N; ++j) c[i][j] += a[i][k] * b[k][j];
    return c;
}

/// exp(A): Taylor series of A / 2^n with a norm below 1/2, squared n times. 18 terms leave less than 1e-21.
template <std::size_t N, class Number> square<N, Number> exponential(square<N, Number> a) {
    double norm = 0;
    for (const auto& row : a) {
        double sum = 0;
        for (const auto& x : row) sum += std::abs(plain(x));
        norm = std::max(norm, sum);
    }
    require(norm < 1e6, "discretize.denominator", norm,
            "has a pole or zero too fast for this period (abs(s) T)");
    int halvings = 0;
    for (; norm > 0.5; norm /= 2) ++halvings;
    square<N, Number> sum{}, term{};
    for (std::size_t i = 0; i < N; ++i) {
        for (auto& x : a[i]) x = x * std::ldexp(1.0, -halvings);
        sum[i][i] = term[i][i] = 1;
    }
    for (int k = 1; k <= 18; ++k) {
        term = times(term, a);
        for (std::size_t i = 0; i < N; ++i)
            for (std::size_t j = 0; j < N; ++j) {
                term[i][j] = term[i][j] / double(k);
                sum[i][j] += term[i][j];
            }
    }
    for (; halvings > 0; --halvings) sum = times(sum, sum);
    return sum;
}

/// How many powers of s a polynomial has, and how many roots of it lie at s = 0.
template <std::size_t Size, class Number> std::size_t degree(const std::array<Number, Size>& p) {
    std::size_t n = Size;
    while (n > 1 && plain(p[n - 1]) == 0) --n;
    return n - 1;
}
template <std::size_t Size, class Number> std::size_t roots_at_zero(const std::array<Number, Size>& p) {
    std::size_t n = 0;
    while (n + 1 < Size && plain(p[n]) == 0) ++n;
    return n;
}

/// p (1 + c z^-1), in place; p has degree < Size - 1.
template <std::size_t Size, class Number> void multiply(std::array<Number, Size>& p, double c) {
    for (std::size_t i = Size - 1; i > 0; --i) p[i] += c * p[i - 1];
}

/// A rate at which all coefficients of s/rate are of the same order: not below 1/T, so that slow poles stay
/// well scaled.
template <std::size_t Size, class Number>
double scale(const std::array<Number, Size>& p, std::size_t degree, double period) {
    double rate = 1 / period;
    for (std::size_t i = 0; i < degree; ++i)
        rate = std::max(rate, std::pow(std::abs(plain(p[i]) / plain(p[degree])), 1.0 / double(degree - i)));
    return rate;
}

/// The companion matrix of p(s), made monic, in units of `rate`, times T.
template <std::size_t N, std::size_t Size, class Number>
square<N, Number> companion(const std::array<Number, Size>& p, std::size_t n, double rate, double period) {
    square<N, Number> a{};
    for (std::size_t i = 0; i < n; ++i) {
        if (i + 1 < n) a[i][i + 1] = rate * period;
        a[n - 1][i] = -p[i] / p[n] * (rate * period * std::pow(rate, -double(n - i)));
    }
    return a;
}

/// The polynomial in z^-1 with a root exp(s T) for every root of p(s), leading coefficient 1: the
/// characteristic polynomial of exp(companion T), after Faddeev and Leverrier. No root is ever computed, so
/// multiple ones do no harm.
template <std::size_t Size, class Number>
std::array<Number, Size> mapped(const std::array<Number, Size>& p, double period) {
    constexpr std::size_t N = Size - 1;
    const std::size_t zeros = roots_at_zero(p), n = degree(p) - zeros;
    std::array<Number, Size> rest{}, q{};
    for (std::size_t i = 0; i <= n; ++i) rest[i] = p[i + zeros];
    const auto e = exponential(companion<N>(rest, n, scale(rest, n, period), period));
    q[0] = 1;
    square<N, Number> m{};
    for (std::size_t k = 1; k <= n; ++k) {
        m = times(e, m);
        for (std::size_t i = 0; i < n; ++i) m[i][i] += q[k - 1];
        Number trace(0);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) trace += e[i][j] * m[j][i];
        q[k] = -trace / double(k);
    }
    for (std::size_t i = 0; i < zeros; ++i) multiply(q, -1.0); // s = 0 goes to z = 1 exactly
    return q;
}

} // namespace detail

} // namespace quadrant::inline v0
