// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/feedforward/backlash_compensation.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
using block = backlash_compensation<>;
/// 20 um of play, crossed at 4 mm/s (2 um a sample), 1 um of hysteresis.
const block::parameters screw{.play = 20_um, .rate = 4_mmps, .hysteresis = 1_um};
quantity<si::length> metres(double x) { return quantity<si::length>::from_value(x); }

/// A load that a motor pushes by either flank of a play; at rest in between.
struct pushed {
    double play, load = 0;
    double operator()(double motor) {
        load = std::clamp(load, motor - play / 2, motor + play / 2);
        return load;
    }
};
/// Repeatable numbers in -1 ... 1.
struct dice {
    unsigned x = 7;
    double operator()() { return double((x = x * 1664525u + 1013904223u) >> 8) / 8388608 - 1; }
};
std::string refusal(const block::parameters& p) {
    try {
        block{p, Ts};
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return "";
}
} // namespace

TEST_CASE("backlash_compensation: 20 um at 4 mm/s and 2 kHz are crossed in 10 samples of 2 um") {
    block f{screw, Ts};
    f.settle(0_m, 1);
    CHECK(f(10_um) == 10_um);
    double last = 10e-6;
    for (int k = 0; k < 10; ++k) {
        CHECK_FALSE((k > 0 && !f.crossing()));
        const double y = f(metres(5e-6 - k * 1e-6)).value();
        CHECK(last - y == doctest::Approx(2e-6).scale(0));
        CHECK(f.rate().value() == doctest::Approx(-4e-3).scale(0));
        last = y;
    }
    CHECK(last == doctest::Approx(-10e-6).scale(0));
    f(-10_um); // what ten steps of 2 um left by rounding
    CHECK(f.now().y == -10_um);
    CHECK_FALSE(f.crossing());
    f(-11_um);
    CHECK(f.rate() == 0_mps);
}
TEST_CASE(
    "backlash_compensation: no step of the output is above rate times period, no output above half the play, "
    "whatever the reference does") {
    block f{screw, Ts};
    dice roll;
    double last = 0, most = 0, step = 0, x = 0;
    int reversals = 0, side = 0;
    for (int k = 0; k < 200000; ++k) {
        x = k % 1000 == 0 ? roll() : x + 3e-6 * roll() + 2e-6 * std::sin(k * 0.01);
        const double y = f(metres(x)).value();
        step = std::max(step, std::abs(y - last)), most = std::max(most, std::abs(y));
        reversals += f.now().side != side;
        last = y, side = f.now().side;
    }
    CHECK(reversals > 1000);
    CHECK(step <= 2e-6 * (1 + 1e-9));
    CHECK(step > 1.99e-6);
    CHECK(most <= 10e-6);
    CHECK(most == 10e-6);
}
TEST_CASE("backlash_compensation: a reference that dithers within the hysteresis does not turn it over, one "
          "beyond does") {
    for (const double width : {0.99e-6, 1.01e-6}) { // peak to peak
        block f{screw, Ts};
        f.settle(0_m);
        for (int k = 0; k < 100; ++k) f(metres(1e-6 * k));
        dice roll;
        int turned = 0;
        for (int k = 0; k < 1000; ++k) {
            f(metres(100e-6 - width / 2 + width / 2 * (k % 2 ? 1 : -1) * (k < 900 ? 1 : std::abs(roll()))));
            turned += f.now().side < 0;
        }
        CHECK((turned > 0) == (width > 1e-6));
        if (width < 1e-6) CHECK(f.now().y == 10_um);
    }
}
TEST_CASE(
    "backlash_compensation: the load follows the reference exactly between reversals and within the hysteresis "
    "once the play is crossed; without, it is 10 um off") {
    for (const bool compensated : {true, false}) {
        block f{screw, Ts};
        pushed load{20e-6};
        double between = 0, crossed = 0;
        int since = 0, side = 0;
        for (int k = 0; k < 20000; ++k) {
            const double x = 1e-3 * std::sin(k * 0.002);
            const double y = f(metres(x)).value();
            since = f.now().side == side ? since + 1 : 0;
            side = f.now().side;
            const double e = std::abs(load(x + (compensated ? y : 0)) - x);
            if (k < 1000) continue;
            if (since > 10) crossed = std::max(crossed, e);
            if (std::abs(std::cos(k * 0.002)) > 0.3) between = std::max(between, e);
        }
        CHECK(between == doctest::Approx(compensated ? 0 : 10e-6).epsilon(1e-6).scale(1e-9));
        if (compensated) CHECK(crossed <= 1e-6);
    }
}
TEST_CASE("backlash_compensation: after reset the side is not known: the first move takes half the play, as "
          "little as may "
          "be wrong") {
    block f{screw, Ts};
    CHECK(f(0.9_um) == 0_m); // within the hysteresis
    CHECK(f(1.1_um) == 2_um);
    for (int k = 0; k < 20; ++k) f(metres(2e-6 + k * 1e-6));
    CHECK(f.now().y == 10_um);
    f.settle(50_mm);
    CHECK(f(50_mm) == 0_m);
    f.settle(50_mm, -1);
    CHECK(f(50_mm) == -10_um);
    CHECK_FALSE(f.crossing());
}
TEST_CASE("backlash_compensation: turned back in the middle of the crossing it goes back from there") {
    block f{screw, Ts};
    f.settle(0_m, 1);
    f(10_um);
    for (int k = 0; k < 5; ++k) f(metres(5e-6 - k * 1e-6));
    CHECK(f.now().y.value() == doctest::Approx(0).scale(1e-9));
    CHECK(f(4_um).value() == doctest::Approx(2e-6).scale(0));
}
TEST_CASE("backlash_compensation: names the field that it refuses") {
    auto p = screw;
    p.rate = {};
    CHECK(refusal(p) == "backlash_compensation.rate = 0 m/s: must be finite and above 0");
    p = screw, p.play = -1_um;
    CHECK(refusal(p) == "backlash_compensation.play = -1e-06 m: must be finite and not below 0");
    p = screw, p.hysteresis = std::numeric_limits<double>::quiet_NaN() * 1_m;
    CHECK(refusal(p).find("backlash_compensation.hysteresis") == 0);
    CHECK(refusal(screw) == "");
}
