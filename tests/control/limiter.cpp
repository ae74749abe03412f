// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/control/limiter.hpp>

#include "../block/dice.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

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
TEST_CASE("limiter: what comes out is finite, whatever the bounds and the input, in random trials") {
    std::mt19937_64 random(9);
    const auto any = [&]<class Real>(Real) { // bits at random: infinities, NaNs and subnormals come, too
        if (random() % 8 == 0)
            return random() % 2 ? std::numeric_limits<double>::infinity()
                                : -std::numeric_limits<double>::infinity();
        return std::bit_cast<double>(random());
    };
    int made = 0, wrong = 0;
    const auto check = [&]<class Real>(Real) {
        using box = limiter<signal::voltage, Real>;
        try {
            box a({any(Real()) * 1_V, any(Real()) * 1_V}, 1_ms);
            ++made;
            const auto x = box::value::from_value(Real(any(Real())));
            wrong += !finite(a(x));
            a.settle(x);
            wrong += !finite(a(x)) || !finite(a(box::value::from_value(Real(1))));
        } catch (const invalid_parameter&) {
        }
    };
    for (int i = 0; i < stated::trials; ++i) i % 2 == 0 ? check(double()) : check(float());
    CHECK(wrong == 0);
    CHECK(made > stated::trials / 5);
}
TEST_CASE("limiter: a bound that is infinite the wrong way is refused, 1e300 in float, too") {
    CHECK_THROWS_WITH_AS((amplifier{{.low = forever, .high = forever}, 1_ms}),
                         "limiter.low = inf V: must leave a finite number above it", invalid_parameter);
    CHECK_THROWS_WITH_AS((amplifier{{.low = -forever, .high = -forever}, 1_ms}),
                         "limiter.high = -inf V: must leave a finite number below it", invalid_parameter);
    CHECK_THROWS_AS((limiter<signal::voltage, float>{{.low = 1e300 * 1_V, .high = forever}, 1_ms}),
                    invalid_parameter);
    CHECK_NOTHROW(amplifier{{.low = -forever, .high = forever}, 1_ms});
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
                         "limiter.high = -10 V: must not lie below low (10 V)", invalid_parameter);
    CHECK_THROWS_WITH_AS((amplifier{{.low = std::nan("") * 1_V, .high = 1_V}, 1_ms}),
                         "limiter.low = nan V: must be a number", invalid_parameter);
    CHECK_THROWS_AS((amplifier{{.low = 1_V, .high = std::nan("") * 1_V}, 1_ms}), invalid_parameter);
    CHECK_NOTHROW(amplifier{{.low = 1_V, .high = 1_V}, 1_ms});
}
