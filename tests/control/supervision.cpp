// SPDX-License-Identifier: BSL-1.0
// axis_enable and following_error: what switches an axis on and off.
#include <quadrant/base/literals.hpp>
#include <quadrant/control/axis_enable.hpp>
#include <quadrant/control/following_error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
using enum power_state;

namespace {
const duration T = 1_ms;
const axis_enable<>::parameters stop{
    .velocity = 1.5_mps, .deceleration = 2_mps2, .emergency_deceleration = 8_mps2, .brake_time = 3_ms};
constexpr power_request run{.enable = true}, idle{}, mushroom{.enable = true, .emergency_stop = true},
    tripping{.enable = true, .trip = true};
const auto here = 10_mm;
} // namespace

TEST_CASE("axis_enable: the stream passes while off and on, and an enable counts when it rises") {
    axis_enable<> power{stop, T};
    CHECK(power(idle, here) == here);
    CHECK_FALSE(power.on());
    CHECK(power(run, 11_mm) == 11_mm);
    CHECK(power.on());
    CHECK(power(tripping, 12_mm) == 12_mm);
    CHECK(power.power() == tripped);
    CHECK_FALSE(power.on());
    for (int k = 0; k < 5; ++k) power(run, here);
    CHECK(power.power() == tripped); // latched as long as enable stays
    power(idle, here);
    CHECK(power.power() == off);
    power(run, here);
    CHECK(power.on());
}

TEST_CASE("axis_enable: a stop takes the way v^2/(2 a) and the time v/a, an emergency stop its own a; then the "
          "brake") {
    std::mt19937 random(7);
    for (int trial = 0; trial < 500; ++trial) {
        const double v = std::uniform_real_distribution(-1.0, 1.0)(random);
        const bool emergency = trial % 2 == 0;
        const double a = emergency ? 8 : 2;
        axis_enable<> power{stop, T};
        double x = 0.3;
        for (int k = 0; k < 3; ++k) power(run, (x += v * 1e-3) * 1_m);
        double before = x, fastest = v;
        int steps = 0;
        for (; power.on() && steps < 2000; ++steps) {
            const double y = power(emergency ? mushroom : idle, 99_m).value(); // the stream is not heard
            if (!power.on()) break; // what comes out now is the stream again
            const double speed = (y - before) / 1e-3;
            CHECK(std::abs(speed - fastest) <= a * 1e-3 * (1 + 1e-9));
            fastest = speed;
            before = y;
        }
        CHECK(std::abs(before - (x + v * std::abs(v) / (2 * a))) <= 1e-12);
        CHECK(std::abs(steps * 1e-3 - (std::abs(v) / a + 3e-3)) <= 1.001e-3); // rounded up to whole samples
        CHECK(power.power() == off);
    }
}

TEST_CASE(
    "axis_enable: an emergency during a gentle stop brakes harder from then on, and its end starts nothing") {
    axis_enable<> power{stop, T};
    power.settle(0_m);
    for (int k = 1; k <= 2; ++k) power(run, k * 1e-3 * 1_m);
    power(idle, 0_m);
    CHECK(power.now().speed.value() == doctest::Approx(1 - 0.002));
    power(mushroom, 0_m);
    CHECK(power.now().speed.value() == doctest::Approx(1 - 0.002 - 0.008));
    for (int k = 0; k < 300; ++k) power(run, 0_m); // the mushroom is pulled, enable has been there all the time
    CHECK(power.power() == off);
    power(idle, 0_m);
    power(mushroom, 0_m); // nor can it be switched on while it is pressed
    power(run, 0_m);
    CHECK(power.power() == off);
}

TEST_CASE("axis_enable: a stop in the sample in which the stream jumped begins with the highest speed that "
          "there is") {
    axis_enable<> power{stop, T};
    power(run, 0_m);
    double x = power(run, 100_mm).value(); // 100 m/s
    for (int k = 0; k < 1000; ++k) x = power.on() ? power(mushroom, 100_mm).value() : x;
    CHECK(power.power() == off);
    power.reset();
    power(run, 0_m);
    power(run, -100_mm);
    const auto at = power(idle, 0_m);
    CHECK(at.value() == doctest::Approx(-0.1 - 1.499e-3));
    for (int k = 0; k < 749; ++k) x = power(idle, 0_m).value();
    CHECK(x == doctest::Approx(-0.1 - 1.5 * 1.5 / 4));
}

TEST_CASE("axis_enable: a reference that is not a number is held and told, a stop is obeyed all the same") {
    axis_enable<> power{stop, T};
    const auto bad = std::nan("") * 1_m;
    power(run, bad);
    CHECK_FALSE(power.on()); // nothing to switch on with
    power.reset();
    power(run, here);
    CHECK(power(run, bad) == here);
    CHECK(power.on());
    CHECK(power.faulted());
    power(tripping, bad);
    CHECK(power.power() == tripped);
}

TEST_CASE("following_error: the window widens with speed, and patience is what it says") {
    following_error<> guard{{.window = 1_mm, .per_speed = 20_ms, .patience = 2_ms}, T};
    CHECK(guard(0.5_mm, 0_mps).value() == doctest::Approx(0.5));
    CHECK_FALSE(guard.warns());
    CHECK(guard(-1.5_mm, -0.1_mps).value() == doctest::Approx(0.5)); // window 3 mm
    CHECK(guard(-2_mm, -0.1_mps).value() == doctest::Approx(2.0 / 3));
    CHECK(guard.warns());
    for (int k = 0; k < 2; ++k) guard(1.1_mm, 0_mps);
    guard(0_m, 0_mps); // two beyond are forgiven, and forgotten
    for (int k = 0; k < 2; ++k) guard(1.1_mm, 0_mps);
    CHECK_FALSE(guard.tripped());
    guard(1.1_mm, 0_mps);
    CHECK(guard.tripped());
    guard(0_m, 0_mps);
    CHECK(guard.tripped()); // latched
    CHECK_FALSE(guard.warns());
    guard.reset();
    CHECK_FALSE(guard.tripped());
    guard(std::nan("") * 1_m, 0_mps); // an encoder that is gone
    CHECK(guard.tripped());
}

TEST_CASE("axis_enable, following_error: refuse what no machine has") {
    const auto without = [](auto change) {
        auto p = stop;
        change(p);
        CHECK_THROWS_AS((axis_enable<>{p, T}), invalid_parameter);
    };
    without([](auto& p) { p.velocity = 0_mps; });
    without([](auto& p) { p.deceleration = 0_mps2; });
    without([](auto& p) { p.emergency_deceleration = -1_mps2; });
    without([](auto& p) { p.brake_time = -1_ms; });
    CHECK_THROWS_WITH_AS((following_error<>{{.window = 0_m, .per_speed = 0_s}, T}),
                         "following_error.window = 0 m: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_AS((following_error<>{{.window = 1_mm, .per_speed = 0_s, .warning = 2}, T}),
                    invalid_parameter);
}
