// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../filter/discretize.hpp"
#include "../observer/matrix.hpp"
#include "../observer/nominal_plant.hpp"
#include "../observer/q_filter.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

/// Polynomials in z^-1, by rising power, for the design of `rst` laws. Design only: runs once, may throw, no
/// allocation.
namespace quadrant::inline v0 {

/// p[0] + p[1] z^-1 + ... + p[Degree] z^-Degree.
template <std::size_t Degree, class Number = double> using z_polynomial = std::array<Number, Degree + 1>;

/// b / a of an axis behind its hold, from command to position: a[0] is one, b[0] is zero (what is commanded now
/// moves nothing now). A delay of whole periods is zeros at the begin of b.
template <std::size_t A, std::size_t B, class Number = double> struct sampled_plant {
    static_assert(A >= 1 && B >= 1, "an axis has inertia");
    z_polynomial<A, Number> a{};
    z_polynomial<B, Number> b{};
};

namespace detail {

/// (1 + c z^-1)^Power p
template <std::size_t Power, class Number, std::size_t N>
auto with_factor(const std::array<Number, N>& p, double c) {
    if constexpr (Power == 0)
        return p;
    else
        return with_factor<Power - 1>(product(p, std::array<Number, 2>{Number(1), Number(c)}), c);
}
template <class Number, std::size_t N> Number at_one(const std::array<Number, N>& p) {
    Number sum(0);
    for (const auto& x : p) sum += x;
    return sum;
}
/// d^-1 m d, d diagonal of powers of two: rows and columns of a size, so that small entries keep their digits.
template <std::size_t N> matrix<N> balanced(matrix<N> m) {
    for (int sweep = 0; sweep < 100; ++sweep) {
        bool done = true;
        for (std::size_t i = 0; i < N; ++i) {
            double row = 0, column = 0;
            for (std::size_t j = 0; j < N; ++j)
                if (j != i) row += std::abs(m[i][j]), column += std::abs(m[j][i]);
            if (!(row > 0) || !(column > 0) || !is_finite(row) || !is_finite(column)) continue;
            const double by = std::exp2(std::round(std::log2(row / column) / 2));
            if (by == 1) continue;
            done = false;
            for (std::size_t j = 0; j < N; ++j) m[i][j] /= by, m[j][i] *= by;
        }
        if (done) break;
    }
    return m;
}
/// Largest |1 + d| of the roots d of p[0] d^n + ... + p[n], p[0] = 1. Where roots z = 1 + d lie close together
/// around one, as those of a slow loop at a high rate do, coefficients in z hold them in their last digits
/// only.
template <class Number, std::size_t N> double largest_root_about_one(const std::array<Number, N>& p) {
    matrix<N - 1> companion{};
    for (std::size_t i = 0; i + 1 < N; ++i) {
        companion[0][i] = -plain(p[i + 1]);
        if (i > 0) companion[i][i - 1] = 1;
    }
    companion = balanced(companion);
    for (std::size_t i = 0; i + 1 < N; ++i) companion[i][i] += 1;
    return spectral_radius(companion);
}
/// Largest |z| of the roots; p[0] is one.
template <class Number, std::size_t N> double largest_root(const std::array<Number, N>& p) {
    if constexpr (N == 1)
        return 0;
    else
        return largest_root_about_one(about_one(p));
}

} // namespace detail

/// The plant that the samples see; `Delay` more periods until the command acts.
template <std::size_t Delay = 0, std::size_t Order, std::size_t Zeros, class Number>
requires(Zeros < Order) sampled_plant<Order, Order + Delay, Number> pulse_transfer(
    const nominal_plant<Order, Zeros, Number>& plant, duration period) {
    continuous<Order, Number> c;
    std::copy(plant.numerator.begin(), plant.numerator.end(), c.numerator.begin());
    c.denominator = plant.denominator;
    const auto d = zero_order_hold(c, period);
    sampled_plant<Order, Order + Delay, Number> y;
    y.a = d.denominator;
    for (std::size_t i = 1; i <= Order; ++i) y.b[i + Delay] = d.numerator[i];
    return y;
}
/// The same of an axis B / (s (s + A)).
template <std::size_t Delay = 0, signal_tag Command, class Number>
auto pulse_transfer(const axis_model<Command, Number>& plant, duration period) {
    return pulse_transfer<Delay>(nominal_plant<2, 0, Number>(plant), period);
}

/// r (R, degree B - 1, r[0] = c[0]) and s (S, degree A - 1) with a R + b S = c: every polynomial c of degree A
/// + B - 1 can be had unless a and b have a root in common. By the Sylvester matrix.
/// Source: [Astrom1997] ch. 5 (Diophantine equation, minimum degree).
/// Throws "diophantine.b = ...: must not share a root with a".
template <std::size_t A, std::size_t B, class Number = double> struct diophantine {
    z_polynomial<B - 1, Number> r{};
    z_polynomial<A - 1, Number> s{};

    diophantine(const z_polynomial<A, Number>& a, const z_polynomial<B, Number>& b,
                const z_polynomial<A + B - 1, Number>& c) {
        const double size = detail::largest(matrix<1, B + 1, Number>{b});
        require(detail::is_finite(size) && size > 0, "diophantine.b", size, "must be finite and not 0");
        matrix<A + B, A + B, Number> m{};
        matrix<A + B, 1, Number> right{};
        for (std::size_t k = 0; k < A + B; ++k) right[k][0] = c[k];
        for (std::size_t j = 0; j < B; ++j)
            for (std::size_t i = 0; i <= A; ++i) m[i + j][j] = a[i];
        for (std::size_t j = 0; j < A; ++j)
            for (std::size_t i = 0; i <= B; ++i) m[i + j][B + j] = b[i] / size;
        const auto x = detail::solved(m, right);
        for (std::size_t j = 0; j < B; ++j) r[j] = x[j][0];
        for (std::size_t j = 0; j < A; ++j) s[j] = x[B + j][0] / size;
        double off = 0;
        for (std::size_t k = 0; k < A + B; ++k) {
            Number sum = -right[k][0];
            for (std::size_t j = 0; j < A + B; ++j) sum += m[k][j] * x[j][0];
            off = detail::is_nan(detail::magnitude(sum)) ? HUGE_VAL : std::max(off, detail::magnitude(sum));
        }
        require(off < 1e-6 * detail::largest(right), "diophantine.b", off,
                "must not share a root with a (rest of the equation)");
    }
};

/// (1 - e^{s T} z^-1)(...) of the pair w, damping of s; of two real poles when damping is above one.
inline z_polynomial<2> pole_pair(frequency natural, double damping, duration period) {
    const double w = 2 * std::numbers::pi * natural.value() * period.value();
    const double in = w * std::sqrt(std::abs(1 - damping * damping)), size = std::exp(-damping * w);
    return {1, -2 * size * (damping < 1 ? std::cos(in) : std::cosh(in)), size * size};
}
/// e^{s T} of one real pole at s = -2 pi at: what stands in 1 - e^{s T} z^-1.
inline double real_pole(frequency at, duration period) {
    return std::exp(-2 * std::numbers::pi * at.value() * period.value());
}

} // namespace quadrant::inline v0
