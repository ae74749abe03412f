// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/minimise.hpp>

#include <doctest/doctest.h>

using namespace quadrant;
using namespace quadrant::analysis;

TEST_CASE("minimise: Rosenbrock's valley from the usual start") {
    const auto fit = minimise(
        [](const std::vector<double>& x) {
            return std::vector<double>{10 * (x[1] - x[0] * x[0]), 1 - x[0]};
        },
        {-1.2, 1});
    CHECK(fit.converged);
    CHECK(fit.x[0] == doctest::Approx(1).epsilon(1e-6));
    CHECK(fit.x[1] == doctest::Approx(1).epsilon(1e-6));
}
TEST_CASE("minimise: on a linear problem the same as least_squares, variance too") {
    least_squares equations(2);
    const std::vector<std::vector<double>> a{{1, 0.5}, {1, 2}, {1, 3}, {1, 7}};
    const std::vector<double> b{1, 3, 2, 5};
    for (std::size_t i = 0; i < 4; ++i) equations.add(a[i], b[i]);
    const auto direct = equations.solve();
    const auto fit = minimise(
        [&](const std::vector<double>& x) {
            std::vector<double> r;
            for (std::size_t i = 0; i < 4; ++i) r.push_back(a[i][0] * x[0] + a[i][1] * x[1] - b[i]);
            return r;
        },
        {0, 0});
    for (std::size_t j = 0; j < 2; ++j) {
        CHECK(fit.x[j] == doctest::Approx(direct.x[j]).epsilon(1e-6));
        CHECK(fit.variance[j] == doctest::Approx(direct.inverse_diagonal[j]).epsilon(1e-6));
    }
    CHECK(fit.cost == doctest::Approx(direct.residual).epsilon(1e-9));
}
TEST_CASE("minimise: an unknown without effect stays, its variance is infinite") {
    const auto fit = minimise(
        [](const std::vector<double>& x) {
            return std::vector<double>{x[0] - 3, 2 * x[0] - 6.5};
        },
        {0, 7});
    CHECK(fit.x[0] == doctest::Approx(3.2));
    CHECK(fit.x[1] == doctest::Approx(7).epsilon(1e-9));
    CHECK(std::isinf(fit.variance[1]));
}
TEST_CASE("minimise: refuses a start where nothing can be computed") {
    CHECK_THROWS_AS(
        minimise([](const std::vector<double>& x) { return std::vector<double>{std::log(x[0])}; }, {-1}),
        invalid_parameter);
}
