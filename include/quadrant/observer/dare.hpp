// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "matrix.hpp"

#include <cmath>
#include <cstddef>

/// The steady state of a Kalman filter or of a quadratic regulator.
namespace quadrant::inline v0 {

/// The stabilizing X of A' X A - X - A' X B (R + B' X B)^-1 B' X A + Q = 0.
/// By structure-preserving doubling: each step does twice as many periods of the recursion as all before
/// together.
/// Source: [Chu2004]; as wpimath's DARE does.
/// Range: A to about 30 states. Scale the states to be of the same order: what one of them lacks beside the
/// others by more than 1e8 is rounding. Bare numbers. Not a step: runs once, may throw; no allocation, any
/// number type. Throws "dare.Q = ...: must be symmetric and positive semidefinite", "dare.R = ...: must be
/// symmetric and positive definite", "dare.A = ...: has a mode that B does not reach or that Q does not weight"
/// (with the spectral radius left).
template <std::size_t N, std::size_t M, class Number>
matrix<N, N, Number> dare(const matrix<N, N, Number>& A, const matrix<N, M, Number>& B,
                          const matrix<N, N, Number>& Q, const matrix<M, M, Number>& R) {
    using namespace detail;
    const auto symmetric = [](const auto& a) {
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (!(magnitude(a[i][j] - a[j][i]) <= 1e-12 * largest(a))) return false;
        return true;
    };
    require_finite("dare.A", largest(A));
    require_finite("dare.B", largest(B));
    require(symmetric(Q) && positive_definite(Q, 1e-12 * (largest(Q) > 0 ? largest(Q) : 1.0)), "dare.Q",
            largest(Q), "must be symmetric and positive semidefinite");
    require(symmetric(R) && positive_definite(R), "dare.R", largest(R),
            "must be symmetric and positive definite");

    matrix<N, N, Number> a = A, g = multiplied(B, solved(R, transposed(B))), h = Q;
    bool converged = false;
    for (int after = 0, step = 0; step < 60 && after < 2; ++step) {
        matrix<N, 2 * N, Number> both{};
        for (std::size_t i = 0; i < N; ++i)
            for (std::size_t j = 0; j < N; ++j) both[i][j] = a[i][j], both[i][N + j] = g[i][j];
        both = solved(added(identity<N, Number>(), multiplied(g, h)), both);
        matrix<N, N, Number> va{}, vg{};
        for (std::size_t i = 0; i < N; ++i)
            for (std::size_t j = 0; j < N; ++j) va[i][j] = both[i][j], vg[i][j] = both[i][N + j];
        const auto more = multiplied(transposed(va), multiplied(h, a));
        g = added(g, multiplied(a, multiplied(vg, transposed(a))));
        h = added(h, more);
        a = multiplied(a, va);
        for (std::size_t i = 0; i < N; ++i) // rounding must not build up an antisymmetric part
            for (std::size_t j = 0; j < i; ++j) {
                h[i][j] = h[j][i] = (h[i][j] + h[j][i]) * 0.5;
                g[i][j] = g[j][i] = (g[i][j] + g[j][i]) * 0.5;
            }
        if (!detail::is_finite(largest(h))) break;
        converged = converged || largest(more) <= 1e-10 * largest(h);
        after += converged; // quadratic: two more make it exact, in the derivatives of a dual too
    }
    const auto x_b = multiplied(h, B);
    const auto under = added(R, multiplied(transposed(B), x_b));
    const auto k = solved(under, multiplied(transposed(x_b), A));
    auto closed = A;
    const auto b_k = multiplied(B, k);
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j < N; ++j) closed[i][j] -= b_k[i][j];
    const double radius = spectral_radius(closed);
    // A mode on the unit circle comes out at 1 but for the rounding of a double root.
    require(converged && radius < 1 - 1e-7, "dare.A", radius,
            "has a mode at or outside the unit circle that B does not reach or that Q does not weight");
    return h;
}

/// Steady gain of a Kalman filter for x[k+1] = step x + w, z = read x + e, where w has the covariance `process`
/// and e `noise`.
template <std::size_t N, class Number = double> struct steady_filter {
    column<N, Number> gain{};         ///< x = predicted + gain (z - read predicted)
    matrix<N, N, Number> predicted{}; ///< covariance before the sample
    Number innovation{};              ///< variance of z - read predicted
    double radius = 0;                ///< largest |eigenvalue| of step (1 - gain read)
};
/// The dual of the regulator's equation. Throws in its names: dare.A is step', dare.B read', dare.Q process,
/// dare.R noise.
template <std::size_t N, class Number>
steady_filter<N, Number> kalman_gain(const matrix<N, N, Number>& step, const column<N, Number>& read,
                                     const matrix<N, N, Number>& process, const Number& noise) {
    matrix<N, 1, Number> c{};
    for (std::size_t i = 0; i < N; ++i) c[i][0] = read[i];
    steady_filter<N, Number> f;
    f.predicted = dare<N, 1, Number>(detail::transposed(step), c, process, {{{noise}}});
    const auto p_c = detail::multiplied(f.predicted, c);
    f.innovation = noise;
    for (std::size_t i = 0; i < N; ++i) f.innovation += read[i] * p_c[i][0];
    auto rest = detail::identity<N, Number>();
    for (std::size_t i = 0; i < N; ++i) {
        f.gain[i] = p_c[i][0] / f.innovation;
        for (std::size_t j = 0; j < N; ++j) rest[i][j] -= f.gain[i] * read[j];
    }
    f.radius = spectral_radius(detail::multiplied(step, rest));
    return f;
}

} // namespace quadrant::inline v0
