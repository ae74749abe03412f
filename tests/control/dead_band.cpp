// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/control/dead_band.hpp>
#include <quadrant/control/limiter.hpp>

#include <doctest/doctest.h>

using namespace quadrant;
using namespace quadrant::literals;
using dead_zone = dead_band<signal::voltage>;

TEST_CASE("dead_band: with 0.5 V, 2 V become 1.5 V and 0.2 V nothing") {
    dead_zone d{{.half_width = 0.5_V}, 500_us};
    CHECK(d(2_V) == 1.5_V);
    CHECK(d(-2_V) == -1.5_V);
    CHECK(d(0.2_V) == 0_V);
    CHECK(d(-0.5_V) == 0_V);
    CHECK(d(0.5_V) == 0_V);
}
TEST_CASE("dead_band: what it takes away is what a limiter lets through") {
    dead_zone d{{.half_width = 0.5_V}, 500_us};
    limiter<signal::voltage> rest{{.low = -0.5_V, .high = 0.5_V}, 500_us};
    for (double x = -3; x <= 3; x += 0.015625) // exact in binary, so is the sum
        CHECK(d(x * 1_V) + rest(x * 1_V) == x * 1_V);
}
TEST_CASE("dead_band: of width 0 it passes everything") {
    dead_zone d{{}, 500_us};
    for (const auto x : {-1e-300, 0.0, 1e-300, 3.0}) CHECK(d(x * 1_V).value() == x);
}
TEST_CASE("dead_band: refuses a negative width") {
    CHECK_THROWS_WITH_AS((dead_zone{{.half_width = -1_V}, 1_ms}),
                         "dead_band.half_width = -1 V: must be finite and not below 0", invalid_parameter);
}
