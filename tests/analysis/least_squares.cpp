// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/least_squares.hpp>

#include <doctest/doctest.h>

using namespace quadrant;
using namespace quadrant::analysis;

TEST_CASE("least_squares: the line through four points, by hand") {
    // y = 6, 5, 7, 10 at 1, 2, 3, 4: slope 1.4, intercept 3.5, residuals 1.1, -1.3, -0.7, 0.9
    least_squares line(2);
    const double y[] = {6, 5, 7, 10};
    for (int i = 0; i < 4; ++i) line.add({1, i + 1.0}, y[i]);
    const auto s = line.solve();
    CHECK(s.x[0] == doctest::Approx(3.5).epsilon(1e-12));
    CHECK(s.x[1] == doctest::Approx(1.4).epsilon(1e-12));
    CHECK(s.residual == doctest::Approx(4.2).epsilon(1e-12));
    CHECK(s.inverse_diagonal[0] ==
          doctest::Approx(1.5).epsilon(1e-12)); // sum x^2 / (n sum (x - mean)^2) = 30/20
    CHECK(s.inverse_diagonal[1] == doctest::Approx(0.2).epsilon(1e-12)); // 1 / 5
}
TEST_CASE("least_squares: keeps eight digits of a Hilbert matrix, whose normal equations would keep none") {
    least_squares hilbert(6); // condition 1.5e7, squared 2e14
    for (int i = 0; i < 8; ++i) {
        std::vector<double> row;
        double sum = 0;
        for (int j = 0; j < 6; ++j) row.push_back(1.0 / (i + j + 1)), sum += row.back();
        hilbert.add(row, sum);
    }
    for (const double x : hilbert.solve().x) CHECK(x == doctest::Approx(1).epsilon(1e-8));
}
TEST_CASE("least_squares: refuses what has no answer") {
    CHECK_THROWS_AS(least_squares(0), invalid_parameter);
    least_squares two(2);
    two.add({1, 1}, 1);
    CHECK_THROWS_AS(two.solve(), invalid_parameter);
    two.add({2, 2}, 1);
    CHECK_THROWS_AS(two.solve(), invalid_parameter); // the same twice
    CHECK_THROWS_AS(two.add({1}, 1), invalid_parameter);
}
