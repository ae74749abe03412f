// SPDX-License-Identifier: BSL-1.0
// A force that repeats in time where the axis itself moves may come with the motion.
#include <quadrant/diagnosis/which/of_the_motion.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace quadrant::diagnosis;

TEST_CASE("a cutting force at a frequency of the motion is one that may come with it") {
    axis_record r;
    r.period = 1e-3;
    for (int k = 0; k < 12000; ++k) {
        const double turn = 2 * std::numbers::pi * k * r.period;
        r.velocity.push_back(20 * std::cos(0.25 * turn) + 15 * std::cos(0.75 * turn + 1));
    }
    const auto at = [](double low, double high) {
        cause c;
        c.effect = "cutting_force";
        c.parameters.push_back({"process.fundamental_Hz", {{(low + high) / 2, low, high}}});
        return c;
    };
    CHECK(detail::repeats_with_the_motion(r, at(0.6, 0.9)));
    CHECK(detail::repeats_with_the_motion(r, at(0.4, 1.2)));
    CHECK(detail::repeats_with_the_motion(r, at(-0.1, 0.5)));
    CHECK_FALSE(detail::repeats_with_the_motion(r, at(3, 3.2)));
    CHECK_FALSE(detail::repeats_with_the_motion(r, cause{}));
}
