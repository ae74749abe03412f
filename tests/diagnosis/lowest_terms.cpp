// SPDX-License-Identifier: BSL-1.0
// Waves by their shortest period.
#include <quadrant/diagnosis/effect/cogging.hpp>
#include <quadrant/diagnosis/which/lowest_terms.hpp>

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;
using quadrant::diagnosis::detail::repeats_in_its_period;

namespace {

/// Cogging whose third and sixth harmonics are all of it, but for a tenth of a per cent of its energy.
candidate by_three_times_the_period() {
    candidate c;
    auto ps = quadrant::diagnosis::detail::repeating<quadrant::diagnosis::detail::cogging_harmonics, 8>(
        "cogging_period_m", "cogging_N", 0.09, 0.5, 40);
    c.fit.plant.cogging = {0.09, {0.3, 0.2, 20, 0.3, 0, 7}, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}};
    c.fit.plant.cogging.count = harmonics::most;
    c.fit.parameters = std::move(ps);
    return c;
}

} // namespace

TEST_CASE("lowest terms: a wave repeats in its period as often as its other harmonics hold next to nothing") {
    CHECK(repeats_in_its_period({}) == 1);
    CHECK(repeats_in_its_period({0, 0, 0}) == 1);
    CHECK(repeats_in_its_period({5}) == 1);
    CHECK(repeats_in_its_period({0, 5}) == 2);
    CHECK(repeats_in_its_period({0.1, 5, 0.1, 3}) == 2);
    CHECK(repeats_in_its_period({0.1, 0, 5, 0, 0, 2, 0, 0}) == 3);
    CHECK(repeats_in_its_period({0, 0, 0, 0, 0, 0, 0, 1}) == 8);
    CHECK(repeats_in_its_period({0.6, 0, 5}) == 1); // 1.4 % of the energy
    CHECK(repeats_in_its_period({0, 4, 3}) == 1);   // two and three have no common measure
}
TEST_CASE(
    "lowest terms: the shorter wave does what the harmonics that matter did, and is searched at its period") {
    candidate c = by_three_times_the_period();
    const harmonics before = c.fit.plant.cogging;
    const auto shorter = quadrant::diagnosis::detail::by_shortest_periods(c);
    REQUIRE(shorter);
    CHECK(shorter->cogging.period == doctest::Approx(0.03));
    CHECK(shorter->cogging.count == harmonics::most);
    REQUIRE(shorter->cogging.sizes().size() >= 2);
    CHECK(shorter->cogging.sizes()[0] == doctest::Approx(20));
    CHECK(shorter->cogging.sizes()[1] == doctest::Approx(7));
    for (double x = 0; x < 0.1; x += 0.0037) CHECK(std::abs(shorter->cogging.at(x) - before.at(x)) < 0.9);
    CHECK(c.fit.plant.cogging.period == 0.09);
    CHECK(c.fit.parameters[0].low < 0.03);
    CHECK(c.fit.parameters[0].high > 0.03);
    CHECK(c.fit.parameters[0].high < 0.04);
    CHECK_FALSE(quadrant::diagnosis::detail::by_shortest_periods(c) ==
                std::nullopt); // the model itself is as it was
}
TEST_CASE("lowest terms: a wave that has them, or a period of the machine file, stays") {
    candidate c = by_three_times_the_period();
    c.fit.plant.cogging = {0.03, {20, 7}, {0.3, 0.6}};
    CHECK_FALSE(quadrant::diagnosis::detail::by_shortest_periods(c));
    c = by_three_times_the_period();
    c.fit.parameters.erase(c.fit.parameters.begin()); // described: not searched
    CHECK_FALSE(quadrant::diagnosis::detail::by_shortest_periods(c));
    c = by_three_times_the_period();
    c.fit.parameters[0].spread = 0.01; // calibrated
    CHECK_FALSE(quadrant::diagnosis::detail::by_shortest_periods(c));
}
