// SPDX-License-Identifier: BSL-1.0
#include <quadrant/control/limiter.hpp>
#include <quadrant/literals.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
using amplifier = limiter<signal::voltage>;
namespace {
const auto forever = quantity<si::electric_potential>::from_value(std::numeric_limits<double>::infinity());
}

TEST_CASE("limiter: 12 V become 10 V, and it says so") {
    amplifier a{{.low = -10_V, .high = 10_V}, 500_us};
    CHECK(a(12_V) == 10_V);
    CHECK(a.limited());
    CHECK(a(-12_V) == -10_V);
    CHECK(a.limited());
    CHECK(a(9.5_V) == 9.5_V);
    CHECK_FALSE(a.limited());
}
TEST_CASE("limiter: exactly at a bound nothing is clipped") {
    amplifier a{{.low = -10_V, .high = 10_V}, 500_us};
    CHECK(a(10_V) == 10_V);
    CHECK_FALSE(a.limited());
    CHECK(a(-10_V) == -10_V);
    CHECK_FALSE(a.limited());
}
TEST_CASE("limiter: bounds need not hold zero") {
    amplifier a{{.low = 1_V, .high = 5_V}, 500_us};
    CHECK(a(0_V) == 1_V);
    CHECK(a(7_V) == 5_V);
}
TEST_CASE("limiter: an infinite bound is no bound, an infinite input is a fault") {
    amplifier a{{.low = -10_V, .high = forever}, 500_us};
    CHECK(a(1e300 * 1_V).value() == 1e300);
    a(3_V);
    CHECK(a(forever) == 3_V);
    CHECK(a.faulted());
}
TEST_CASE("limiter: settle tells of clipping as a step does") {
    amplifier a{{.low = -10_V, .high = 10_V}, 500_us};
    a.settle(12_V);
    CHECK(a.limited());
    a.reset();
    CHECK_FALSE(a.limited());
}
TEST_CASE("limiter: refuses bounds in the wrong order, and no numbers") {
    CHECK_THROWS_WITH_AS((amplifier{{.low = 10_V, .high = -10_V}, 1_ms}),
                         "limiter.high = -10: must not lie below low (10)", invalid_parameter);
    CHECK_THROWS_WITH_AS((amplifier{{.low = std::nan("") * 1_V, .high = 1_V}, 1_ms}),
                         "limiter.low = nan: must be a number", invalid_parameter);
    CHECK_THROWS_AS((amplifier{{.low = 1_V, .high = std::nan("") * 1_V}, 1_ms}), invalid_parameter);
    CHECK_NOTHROW(amplifier{{.low = 1_V, .high = 1_V}, 1_ms});
}
