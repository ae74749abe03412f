// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/sensor/cyclic_error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
using doctest::Approx;
using std::numbers::pi;
const duration T = 500_us;
} // namespace

TEST_CASE("cyclic_error: 0.1 um over 4 um read 1.1 um at 1 um and 2.9 um at 3 um") {
    cyclic_error<> scale{{4_um, {0.1_um}, {}}, T};
    CHECK(scale(1_um).value() == Approx(1.1e-6).epsilon(1e-12));
    CHECK(scale(2_um).value() == Approx(2.0e-6).epsilon(1e-12));
    CHECK(scale(3_um).value() == Approx(2.9e-6).epsilon(1e-12));
}

TEST_CASE("cyclic_error: at constant speed a ripple of that size at speed/period, whatever the speed") {
    for (const double speed : {2e-4, 8e-4}) { // 50 and 200 Hz
        cyclic_error<2> scale{{4_um, {0.1_um, 0.03_um}, {0.3, 1.0}}, T};
        double first = 0, second = 0, a = 0, b = 0;
        for (int k = 0; k < 2000; ++k) {
            const double x = speed * k * T.value(), e = scale(x * 1_m).value() - x,
                         turn = 2 * pi * speed / 4e-6 * k * T.value();
            first += e * std::sin(turn) / 1000, second += e * std::cos(turn) / 1000;
            a += e * std::sin(2 * turn) / 1000, b += e * std::cos(2 * turn) / 1000;
        }
        CHECK(std::hypot(first, second) == Approx(1e-7).epsilon(1e-6).scale(0));
        CHECK(std::atan2(second, first) == Approx(0.3).epsilon(1e-6));
        CHECK(std::hypot(a, b) == Approx(3e-8).epsilon(1e-6).scale(0));
        CHECK(std::atan2(b, a) == Approx(1.0).epsilon(1e-6));
    }
}

TEST_CASE("cyclic_error: as steep as it may be, the reading never runs backwards; steeper is refused") {
    cyclic_error<> scale{{4_um, {0.6366_um}, {}}, T}; // 4/(2 pi) = 0.63662
    double before = scale(0_m).value();
    bool rises = true;
    for (int i = 1; i < 1000; ++i) {
        const double y = scale(i * 8e-9 * 1_m).value();
        rises = rises && y > before;
        before = y;
    }
    CHECK(rises);
    CHECK_THROWS_WITH_AS(
        (cyclic_error<>{{4_um, {0.64_um}, {}}, T}),
        "cyclic_error.size = 6.4e-07 m: must not let the reading run backwards (2 pi sum i size_i <= period)",
        invalid_parameter);
    CHECK_THROWS_WITH_AS((cyclic_error<>{{0_um, {0_um}, {}}, T}),
                         "cyclic_error.period = 0 m: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_WITH_AS((cyclic_error<>{{4_um, {0_um}, {}}, -1_s}),
                         "cyclic_error.sample_period = -1 s: must be finite and above 0", invalid_parameter);
}
