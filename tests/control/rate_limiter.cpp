// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/control/rate_limiter.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
using ramp = rate_limiter<signal::voltage>;

TEST_CASE("rate_limiter: at 1000 V/s and 2 kHz a jump of 10 V takes 20 samples") {
    ramp r{{.rate = 1000_V / 1_s}, 500_us};
    for (int k = 1; k < 20; ++k) {
        CHECK(r(10_V).value() == doctest::Approx(0.5 * k).epsilon(1e-14));
        CHECK(r.limited());
    }
    CHECK(r(10_V).value() == doctest::Approx(10).epsilon(1e-14));
    CHECK(r(10_V) == 10_V);
    CHECK_FALSE(r.limited());
}
TEST_CASE("rate_limiter: down is as slow as up") {
    ramp r{{.rate = 1000_V / 1_s}, 500_us};
    r.settle(10_V);
    CHECK(r(0_V) == 9.5_V);
    CHECK(r.limited());
}
TEST_CASE("rate_limiter: what is slow enough passes unchanged") {
    ramp r{{.rate = 1000_V / 1_s}, 500_us};
    for (int k = 0; k < 100; ++k) {
        const auto x = 0.4 * std::sin(k) * 0.5 * 1_V;
        CHECK(r(x) == x);
        CHECK_FALSE(r.limited());
    }
}
TEST_CASE("rate_limiter: settle jumps, an infinite rate is no bound") {
    ramp r{{.rate = 1000_V / 1_s}, 500_us};
    r(7_V);
    CHECK(r.limited());
    r.settle(7_V);
    CHECK_FALSE(r.limited());
    CHECK(r(7_V) == 7_V);
    ramp free{{.rate = std::numeric_limits<double>::infinity() * (1_V / 1_s)}, 500_us};
    CHECK(free(1e6 * 1_V).value() == 1e6);
    CHECK_FALSE(free.limited());
}
TEST_CASE("rate_limiter: refuses a rate that never arrives") {
    CHECK_THROWS_WITH_AS((ramp{{.rate = 0_V / 1_s}, 1_ms}),
                         "rate_limiter.rate = 0 V/s: must be above 0 (infinite: no bound)", invalid_parameter);
    CHECK_THROWS_AS((ramp{{.rate = std::nan("") * (1_V / 1_s)}, 1_ms}), invalid_parameter);
}
