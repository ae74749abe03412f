// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/memory/delay_line.hpp>
#include <quadrant/process/cutting_force.hpp>

#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
using four = lanes<4>;

namespace {
template <class Unit> quantity<Unit, four> each_of(quantity<Unit>, const std::array<double, 4>& x) {
    return quantity<Unit, four>::from_value(four(x));
}
} // namespace

TEST_CASE("lanes: a constructor refuses the lane that breaks the rule, and names its value") {
    const four width(0.1);
    CHECK_THROWS_WITH_AS((notch<signal::force, four>({each_of(1_Hz, {100, 200, 1200, 300}), width}, 500_us)),
                         "notch.centre = 1200 Hz: must lie between 0 and half the sampling rate (1000 Hz)",
                         invalid_parameter);
    CHECK_THROWS_WITH_AS(
        (notch<signal::force, four>(
            {each_of(1_Hz, {100, 200, 500, 300}), four(std::array{0.1, -2.0, 0.1, 0.1})}, 500_us)),
        "notch.width = -2: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_WITH_AS(
        (limiter<signal::force, four>({each_of(1_N, {0, 0, 0, 5}), each_of(1_N, {1, 1, 1, 4})}, 500_us)),
        "limiter.high = 4 N: must not lie below low (5 N)", invalid_parameter);
    CHECK_THROWS_WITH_AS((delay_line<signal::force, 7, four>({{0, 7, 8, 1}}, 500_us)),
                         "delay_line.length = 8: must not exceed the capacity (7)", invalid_parameter);
}

TEST_CASE("lanes: the cutting force of each lane is that of its own harmonics, bit for bit") {
    using together = cutting_force<2, four>;
    harmonic_table<2, four> table;
    table.real = {four(std::array{1.0, -2.0, 0.3, 4.0}), four(std::array{0.5, 0.0, 1.5, -1.0})};
    table.imaginary = {four(0.7), four(std::array{-0.1, 0.2, -0.3, 0.4})};
    const std::array<double, 4> scales{10, 20, 30, 40};
    together all({.fundamental = 60_Hz, .scale = each_of(1_N, scales), .harmonics = table, .entry = 50_ms},
                 500_us);
    for (std::size_t i = 0; i < 4; ++i) {
        cutting_force<2> one({.fundamental = 60_Hz,
                              .scale = scales[i] * 1_N,
                              .harmonics = {lane(table.real, i), lane(table.imaginary, i)},
                              .entry = 50_ms},
                             500_us);
        all.reset();
        for (int k = 0; k < 300; ++k) {
            if (k == 100) one.engage(false), all.engage(false);
            REQUIRE(lane(all(), i) == one());
        }
        all.engage(true);
    }
}

TEST_CASE("lanes: a sine far from zero is the C library's, and a lane does not depend on its neighbours") {
    for (const double far : {4e5, 1e6, 1e15, 1e300, std::numeric_limits<double>::infinity()}) {
        four x(0.3);
        x.set(2, far);
        if (far > 412e3 && std::isfinite(far)) CHECK(sin(x)[2] == std::sin(far));
        if (std::isinf(far)) CHECK(std::isnan(cos(x)[2]));
        CHECK(sin(x)[1] == sin(four(0.3))[1]);
        CHECK(cos(x)[0] == cos(four(0.3))[0]);
        if (std::isfinite(far)) CHECK(sin(x)[2] == doctest::Approx(std::sin(far)).epsilon(1e-15));
    }
}
