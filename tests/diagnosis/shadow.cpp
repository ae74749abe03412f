// SPDX-License-Identifier: BSL-1.0
#include <quadrant/diagnosis/which/shadow.hpp>

#include <doctest/doctest.h>
#include <numbers>

using namespace quadrant::diagnosis;

TEST_CASE(
    "shadow: a wave of the same period is the shadow of another a quarter aside, not in phase with it, and "
    "not where the record holds the two periods apart") {
    const auto wave = [](double period, double degrees) {
        return harmonics(period, {3}, {degrees * std::numbers::pi / 180});
    };
    constexpr double travel = 0.2;
    const harmonics cogging = wave(0.012, 29);
    CHECK(detail::lies_a_quarter_aside(cogging, wave(0.01201, 29 + 86), travel));
    CHECK(detail::lies_a_quarter_aside(cogging, wave(0.012, 29 - 96), travel));
    CHECK_FALSE(detail::lies_a_quarter_aside(cogging, wave(0.012, 29), travel));
    CHECK_FALSE(detail::lies_a_quarter_aside(cogging, wave(0.012, 29 + 180), travel));
    CHECK_FALSE(detail::lies_a_quarter_aside(cogging, wave(0.013, 29 + 90), travel));
    CHECK_FALSE(detail::lies_a_quarter_aside(cogging, harmonics(0.012, {}, {}), travel));

    // The first harmonic of a wave whose second one is the large one is noise, and says nothing of the phase.
    const auto two = [](double degrees) {
        return harmonics(0.012, {3, 20}, {0.2, degrees * std::numbers::pi / 180});
    };
    const harmonics friction(0.012, {0.03, 0.2}, {0.2 + std::numbers::pi / 2, 1});
    CHECK_FALSE(detail::lies_a_quarter_aside(two(1 * 180 / std::numbers::pi), friction, travel));
    CHECK(detail::lies_a_quarter_aside(two(1 * 180 / std::numbers::pi + 90), friction, travel));
    CHECK_FALSE(detail::lies_a_quarter_aside(two(50), cogging, travel)); // without that harmonic
}
