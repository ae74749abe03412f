// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/control/proportional.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
using position_loop = proportional<signal::position, signal::velocity>;

TEST_CASE("proportional: 150/s makes 3 mm/s of 20 um") {
    position_loop p{{.gain = 150.0 / 1_s}, 500_us};
    CHECK(p(20_um).value() == doctest::Approx(3e-3).epsilon(1e-15));
    CHECK(p(-20_um).value() == doctest::Approx(-3e-3).epsilon(1e-15));
}
TEST_CASE("proportional: a negative gain turns the sign, a gain of zero gives zero") {
    position_loop turned{{.gain = -150.0 / 1_s}, 500_us}, none{{}, 500_us};
    CHECK(turned(20_um) == -position_loop{{.gain = 150.0 / 1_s}, 500_us}(20_um));
    CHECK(none(20_um).value() == 0);
}
TEST_CASE("proportional: an infinite input is a fault even at gain zero") {
    position_loop none{{}, 500_us};
    none(quantity<si::length>::from_value(std::numeric_limits<double>::infinity()));
    CHECK(none.faulted());
}
TEST_CASE("proportional: refuses a gain that is not finite, and a period that is not above 0") {
    const auto infinite = std::numeric_limits<double>::infinity() / 1_s;
    CHECK_THROWS_WITH_AS((position_loop{{.gain = infinite}, 1_ms}),
                         "proportional.gain = inf per s: must be finite", invalid_parameter);
    CHECK_THROWS_WITH_AS((position_loop{{.gain = 1.0 / 1_s}, 0_ms}),
                         "proportional.period = 0 s: must be finite and above 0", invalid_parameter);
}
