// SPDX-License-Identifier: BSL-1.0
// A regression of a record in pieces, as step tests and several records in one file are.
#include <quadrant/diagnosis/fit/regression.hpp>

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace quadrant::diagnosis;

namespace {
constexpr double period = 0.005, mass = 0.3, viscous = 1.2, coulomb = 0.8;

/// Strokes that begin at rest and end at their fastest; behind each, where the axis is brought back, `missing`
/// rows without a reading.
axis_log strokes(std::size_t missing) {
    axis_log log;
    double x = 0;
    for (const double fastest : {3.0, -3.0, 5.0, -5.0}) {
        constexpr std::size_t rows = 2400;
        for (std::size_t k = 0; k < rows; ++k) {
            const double w = std::numbers::pi / 2 / (rows * period),
                         phase = w * static_cast<double>(k) * period;
            const double v = fastest * std::sin(phase) * std::sin(phase), a = fastest * w * std::sin(2 * phase);
            log.position.push_back(x);
            log.command.push_back(mass * a + viscous * v + (v > 0 ? coulomb : v < 0 ? -coulomb : 0));
            log.left_out.push_back(0);
            x += v * period;
        }
        for (std::size_t k = 0; k < missing; ++k) {
            log.position.push_back(x * static_cast<double>(missing - k) / static_cast<double>(missing));
            log.command.push_back(0);
            log.left_out.push_back(1);
        }
        if (missing > 0) x = 0;
    }
    return log;
}
} // namespace

TEST_CASE("regress: what lies in a gap, and the step of a motion that goes on into it, is no motion") {
    for (const std::size_t missing : {std::size_t{200}, std::size_t{4000}}) {
        const axis_regression found = regress(strokes(missing), period);
        CAPTURE(missing);
        CHECK(found.speed.value == doctest::Approx(viscous).epsilon(0.02));
        CHECK(found.direction.value == doctest::Approx(coulomb).epsilon(0.04));
        CHECK(found.acceleration.value == doctest::Approx(mass).epsilon(0.1));
    }
}

TEST_CASE("regress: a few rows without a reading part no record, and pieces too short to filter say nothing") {
    axis_log log = strokes(0);
    for (std::size_t k = 50; k < log.left_out.size(); k += 97) log.left_out[k] = 1;
    CHECK(regress(log, period).speed.value == doctest::Approx(regress(strokes(0), period).speed.value));
    std::fill(log.left_out.begin(), log.left_out.end(), 1);
    for (std::size_t k = 0; k < log.left_out.size(); k += 400) log.left_out[k] = 0;
    CHECK_FALSE(regress(log, period).speed.sure());
}
