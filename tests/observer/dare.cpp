// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/observer/dare.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace quadrant;
using doctest::Approx;
namespace {
const matrix<3> A{{{1, 0.1, 0}, {0, 0.9, 0.2}, {0.3, 0, 1.1}}};
const matrix<3, 2> B{{{0, 1}, {0.5, 0}, {1, 0.2}}};
const matrix<3> Q{{{2, 0, 0}, {0, 1, 0}, {0, 0, 0.5}}};
const matrix<2> R{{{1, 0.1}, {0.1, 0.5}}};

/// Largest entry of the equation's left-hand side.
template <std::size_t N, std::size_t M>
double residual(const matrix<N>& a, const matrix<N, M>& b, const matrix<N>& q, const matrix<M>& r,
                const matrix<N>& x) {
    using namespace quadrant::detail;
    const auto at = transposed(a);
    const auto bt = transposed(b);
    auto left = added(multiplied(at, multiplied(x, a)), q);
    const auto k = solved(added(r, multiplied(bt, multiplied(x, b))), multiplied(bt, multiplied(x, a)));
    const auto minus = multiplied(at, multiplied(x, multiplied(b, k)));
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j < N; ++j) left[i][j] -= x[i][j] + minus[i][j];
    return largest(left);
}
} // namespace

TEST_CASE("dare: gives scipy's solution for three unstable states and two inputs") {
    // scipy.linalg.solve_discrete_are([[1,.1,0],[0,.9,.2],[.3,0,1.1]], [[0,1],[.5,0],[1,.2]], diag([2,1,.5]),
    // [[1,.1],[.1,.5]])
    const matrix<3> X{{{2.4403349940940458, -0.03268542188392094, 0.15103055675054933},
                       {-0.03268542188392094, 3.0220275378054033, -0.32633787001093295},
                       {0.15103055675054933, -0.32633787001093295, 1.1953213105752867}}};
    const auto x = dare(A, B, Q, R);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) CHECK(x[i][j] == Approx(X[i][j]).epsilon(1e-13));
    CHECK(residual(A, B, Q, R, x) < 1e-14);
}
TEST_CASE("dare: a double integrator weighted by its position alone: {{2, 1}, {1, 1.5}}") {
    // scipy.linalg.solve_discrete_are([[1,1],[0,1]], [[.5],[1]], diag([1,0]), [[1]]) to 1e-15
    const matrix<2> a{{{1, 1}, {0, 1}}}, q{{{1, 0}, {0, 0}}};
    const auto x = dare<2, 1, double>(a, {{{0.5}, {1}}}, q, {{{1}}});
    CHECK(x[0][0] == Approx(2).epsilon(1e-14));
    CHECK(x[0][1] == Approx(1).epsilon(1e-14));
    CHECK(x[1][1] == Approx(1.5).epsilon(1e-14));
}
TEST_CASE("dare: a scalar equation has the root of its quadratic, and a dual the slope of that root") {
    // a = b = q = r = 1: x^2 - x - 1 = 0, the golden ratio; by q: x = (q + sqrt(q^2 + 4 q)) / 2, slope 1/2 +
    // 3/(2 sqrt 5)
    using D = dual<1>;
    const auto x = dare<1, 1, D>({{{1}}}, {{{1}}}, {{{D::variable(1, 0)}}}, {{{1}}});
    CHECK(x[0][0].value == Approx((1 + std::sqrt(5)) / 2).epsilon(1e-15));
    CHECK(x[0][0].partial[0] == Approx(0.5 + 1.5 / std::sqrt(5)).epsilon(1e-14));
}
TEST_CASE("dare: refuses what has no stabilizing solution, and weights that are none") {
    const matrix<2> unit = detail::identity<2>();
    const matrix<2, 1> first{{{1}, {0}}};
    const matrix<1> one{{{1}}};
    // The second state grows and no input reaches it.
    CHECK_THROWS_WITH_AS((dare<2, 1, double>({{{0.5, 0}, {0, 1.1}}}, first, unit, one)),
                         doctest::Contains("that B does not reach or that Q does not weight"),
                         invalid_parameter);
    // It stands still and is not reached.
    CHECK_THROWS_AS((dare<2, 1, double>({{{0.5, 0}, {0, 1}}}, first, unit, one)), invalid_parameter);
    // It stands still and is not weighted.
    CHECK_THROWS_AS((dare<2, 2, double>({{{0.5, 0}, {0, 1}}}, unit, {{{1, 0}, {0, 0}}}, unit)),
                    invalid_parameter);
    // It dies out by itself: nothing to refuse.
    CHECK_NOTHROW((dare<2, 1, double>({{{0.5, 0}, {0, 0.9}}}, first, {{{1, 0}, {0, 0}}}, one)));
    CHECK_THROWS_WITH_AS((dare<2, 1, double>(unit, first, {{{1, 0}, {0, -1}}}, one)),
                         "dare.Q = 1: must be symmetric and positive semidefinite", invalid_parameter);
    CHECK_THROWS_AS((dare<2, 1, double>(unit, first, {{{1, 0.5}, {0, 1}}}, one)), invalid_parameter);
    CHECK_THROWS_WITH_AS((dare<2, 1, double>(unit, first, unit, {{{0}}})),
                         "dare.R = 0: must be symmetric and positive definite", invalid_parameter);
    CHECK_THROWS_AS((dare<2, 1, double>({{{std::nan(""), 0}, {0, 1}}}, first, unit, one)), invalid_parameter);
}
TEST_CASE("spectral_radius: of a rotation, of a Jordan block, of nilpotent and of no numbers") {
    CHECK(spectral_radius(matrix<2>{{{0, 0.9}, {-0.9, 0}}}) == Approx(0.9).epsilon(1e-14));
    CHECK(spectral_radius(matrix<2>{{{0.5, 100}, {0, 0.5}}}) == Approx(0.5).epsilon(1e-6)); // a double root
    CHECK(spectral_radius(matrix<2>{{{3, 1}, {0, -4}}}) == Approx(4).epsilon(1e-12));
    CHECK(spectral_radius(matrix<2>{{{0, 1}, {0, 0}}}) == 0);
    CHECK_FALSE(spectral_radius(matrix<2>{{{std::nan(""), 1}, {0, 0}}}) < 1);
}
TEST_CASE("sampled: a mass with a drifting force has the integrals of its noise") {
    const matrix<3> f{{{0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
    const double h = 0.5, q = 3;
    const auto s = sampled<3, double>(f, {0, 2, 0}, {{{0, 0, 0}, {0, 0, 0}, {0, 0, q}}}, h);
    CHECK(s.step[0][2] == Approx(h * h / 2).epsilon(1e-15));
    CHECK(s.from_input[0] == Approx(h * h).epsilon(1e-15));
    CHECK(s.from_input[1] == Approx(2 * h).epsilon(1e-15));
    CHECK(s.noise[2][2] == Approx(q * h).epsilon(1e-14));
    CHECK(s.noise[1][2] == Approx(q * h * h / 2).epsilon(1e-14));
    CHECK(s.noise[1][1] == Approx(q * std::pow(h, 3) / 3).epsilon(1e-14));
    CHECK(s.noise[0][2] == Approx(q * std::pow(h, 3) / 6).epsilon(1e-14));
    CHECK(s.noise[0][1] == Approx(q * std::pow(h, 4) / 8).epsilon(1e-14));
    CHECK(s.noise[0][0] == Approx(q * std::pow(h, 5) / 20).epsilon(1e-14));
}
