// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../filter/pole_mapping.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>

/// Small matrices of fixed size for the design of observers: rows of std::array, any number type, no Eigen (a
/// scalar loop that includes an observer compiles as fast as before), no allocation. Design only; the steps
/// write out what they need.
namespace quadrant::inline v0 {

/// Rows of numbers: m[row][column].
template <std::size_t Rows, std::size_t Columns = Rows, class Number = double>
using matrix = std::array<std::array<Number, Columns>, Rows>;
/// A column vector.
template <std::size_t Size, class Number = double> using column = std::array<Number, Size>;

namespace detail {

inline double magnitude(const std::complex<double>& x) noexcept { return std::abs(x); }
template <class Number> double magnitude(const Number& x) noexcept { return std::abs(double(plain(x))); }

template <std::size_t N, class Number = double> matrix<N, N, Number> identity() {
    matrix<N, N, Number> a{};
    for (std::size_t i = 0; i < N; ++i) a[i][i] = 1;
    return a;
}
template <std::size_t R, std::size_t K, std::size_t C, class Number>
matrix<R, C, Number> multiplied(const matrix<R, K, Number>& a, const matrix<K, C, Number>& b) {
    matrix<R, C, Number> c{};
    for (std::size_t i = 0; i < R; ++i)
        for (std::size_t k = 0; k < K; ++k)
            for (std::size_t j = 0; j < C; ++j) c[i][j] += a[i][k] * b[k][j];
    return c;
}
template <std::size_t R, std::size_t C, class Number>
matrix<C, R, Number> transposed(const matrix<R, C, Number>& a) {
    matrix<C, R, Number> t{};
    for (std::size_t i = 0; i < R; ++i)
        for (std::size_t j = 0; j < C; ++j) t[j][i] = a[i][j];
    return t;
}
template <std::size_t R, std::size_t C, class Number>
matrix<R, C, Number> added(matrix<R, C, Number> a, const matrix<R, C, Number>& b) {
    for (std::size_t i = 0; i < R; ++i)
        for (std::size_t j = 0; j < C; ++j) a[i][j] += b[i][j];
    return a;
}
template <std::size_t R, std::size_t C, class Number> double largest(const matrix<R, C, Number>& a) {
    double most = 0;
    for (const auto& row : a)
        for (const auto& x : row)
            most = detail::is_nan(magnitude(x)) ? magnitude(x) : std::max(most, magnitude(x));
    return most;
}
/// a^-1 b by elimination with partial pivoting; not finite when a is singular.
template <std::size_t N, std::size_t C, class Number>
matrix<N, C, Number> solved(matrix<N, N, Number> a, matrix<N, C, Number> b) {
    for (std::size_t i = 0; i < N; ++i) {
        std::size_t best = i;
        for (std::size_t r = i + 1; r < N; ++r)
            if (magnitude(a[r][i]) > magnitude(a[best][i])) best = r;
        std::swap(a[i], a[best]), std::swap(b[i], b[best]);
        for (std::size_t r = i + 1; r < N; ++r) {
            const Number m = a[r][i] / a[i][i];
            for (std::size_t j = i; j < N; ++j) a[r][j] -= m * a[i][j];
            for (std::size_t j = 0; j < C; ++j) b[r][j] -= m * b[i][j];
        }
    }
    for (std::size_t i = N; i-- > 0;)
        for (std::size_t j = 0; j < C; ++j) {
            for (std::size_t k = i + 1; k < N; ++k) b[i][j] -= a[i][k] * b[k][j];
            b[i][j] = b[i][j] / a[i][i];
        }
    return b;
}

/// x^T A x > -slack for every x of length one, by Cholesky's factorization of A + slack.
template <std::size_t N, class Number> bool positive_definite(const matrix<N, N, Number>& a, double slack = 0) {
    matrix<N> l{};
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = plain(a[i][j]) + (i == j ? slack : 0);
            for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
            if (i == j && !(sum > 0)) return false;
            l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
        }
    return true;
}

} // namespace detail

/// Largest |eigenvalue|: below 1 a sampled system is stable. Gelfand's lim |A^k|^(1/k), k = 2^40 by squaring;
/// no eigenvalue is computed, so multiple ones do no harm beyond their own sensitivity to rounding.
template <std::size_t N, class Number> double spectral_radius(const matrix<N, N, Number>& a) {
    matrix<N> p{};
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j < N; ++j) p[i][j] = detail::plain(a[i][j]);
    double exponent = 0, share = 1;
    for (int squarings = 0; squarings < 40; ++squarings, share /= 2) {
        const double size = detail::largest(p);
        if (!(size > 0)) return size; // all zero: 0; not a number: that
        exponent += share * std::log(size);
        for (auto& row : p)
            for (auto& x : row) x /= size;
        p = detail::multiplied(p, p);
    }
    return std::exp(exponent);
}

/// A continuous system dx/dt = F x + G u (+ noise of intensity `noise`) over one period, exact for a held u.
template <std::size_t N, class Number = double> struct sampled_system {
    matrix<N, N, Number> step;    ///< exp(F T)
    column<N, Number> from_input; ///< integral of exp(F t) G
    matrix<N, N, Number> noise;   ///< covariance that the noise adds in a period
};
/// Source: the integrals by matrix exponentials, [VanLoan1978].
template <std::size_t N, class Number>
sampled_system<N, Number> sampled(const matrix<N, N, Number>& f, const column<N, Number>& g,
                                  const matrix<N, N, Number>& noise, double period) {
    sampled_system<N, Number> s{};
    matrix<N + 1, N + 1, Number> a{};
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = 0; j < N; ++j) a[i][j] = f[i][j] * period;
        a[i][N] = g[i] * period;
    }
    const auto e = detail::exponential(a);
    matrix<2 * N, 2 * N, Number> b{};
    const double intensity =
        detail::largest(noise) * period; // a density of any unit: taken out where it is large
    const double scale = intensity > 1 ? intensity : 1;
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j < N; ++j) {
            s.step[i][j] = e[i][j];
            b[i][j] = -f[i][j] * period;
            b[N + i][N + j] = f[j][i] * period;
            b[i][N + j] = noise[i][j] * (period / scale);
        }
    const auto v = detail::exponential(b);
    for (std::size_t i = 0; i < N; ++i) {
        s.from_input[i] = e[i][N];
        for (std::size_t j = 0; j < N; ++j)
            for (std::size_t k = 0; k < N; ++k) s.noise[i][j] += e[i][k] * v[k][N + j] * scale;
    }
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j < i; ++j)
            s.noise[i][j] = s.noise[j][i] = (s.noise[i][j] + s.noise[j][i]) * 0.5;
    return s;
}

} // namespace quadrant::inline v0
