// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/feedforward/cogging_harmonics.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
using block = cogging_harmonics<3>;
const block::parameters motor{.pitch = 24_mm, .harmonics = {{{1, 20_N, 0.3}, {6, 8_N, -1.1}, {2, -3_N, 2.0}}}};
struct angle {
    using unit = si::dimensionless;
    static constexpr const char* text = "rad";
};
double expected(double x) {
    const double a = 2 * std::numbers::pi * x / 0.024;
    return 20 * std::sin(a + 0.3) + 8 * std::sin(6 * a - 1.1) - 3 * std::sin(2 * a + 2);
}
quantity<si::length> metres(double x) { return quantity<si::length>::from_value(x); }
std::string refusal(const block::parameters& p) {
    try {
        block{p, Ts};
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return "";
}
} // namespace

TEST_CASE("cogging_harmonics: 20 N of order 1 with phase 0 on a pitch of 24 mm: 10 N at 2 mm, 20 N at 6 mm, "
          "-10 N at 14 mm") {
    cogging_harmonics<1> f{{24_mm, {{{1, 20_N, 0}}}}, Ts};
    CHECK(f(2_mm).value() == doctest::Approx(10));
    CHECK(f(6_mm).value() == doctest::Approx(20));
    CHECK(f(14_mm).value() == doctest::Approx(-10));
    CHECK(f(0_mm) == 0_N);
}
TEST_CASE("cogging_harmonics: is the sum of its sines, over several pitches both ways, to 1e-12 N") {
    block f{motor, Ts};
    for (double x = -0.1; x < 0.1; x += 0.37e-3) CHECK(std::abs(f(metres(x)).value() - expected(x)) < 1e-12);
}
TEST_CASE(
    "cogging_harmonics: repeats every pitch; a million pitches away to 1e-7 N: 5 pm of rounding on 19 kN/m") {
    block f{motor, Ts};
    for (double x = 0; x < 0.024; x += 0.5e-3) {
        CHECK(std::abs((f(metres(x + 0.024)) - f(metres(x))).value()) < 1e-11);
        CHECK(std::abs((f(metres(x - 1e6 * 0.024)) - f(metres(x))).value()) < 1e-7);
    }
    CHECK(std::abs(f(metres(1e300)).value()) <= 31); // no meaning, but within the sum of its amplitudes
    CHECK_FALSE(f.faulted());
}
TEST_CASE("cogging_harmonics: an amplitude of 0 is a place that is not used") {
    block f{{24_mm, {{{1, 20_N, 0.3}, {}, {}}}}, Ts};
    cogging_harmonics<1> one{{24_mm, {{{1, 20_N, 0.3}}}}, Ts};
    for (double x = 0; x < 0.03; x += 1e-3) CHECK(f(metres(x)) == one(metres(x)));
}
TEST_CASE("cogging_harmonics: in amperes over an angle, as a rotary axis has it") {
    cogging_harmonics<1, signal::current, angle> f{{2 * std::numbers::pi, {{{7, 0.87_A, 0}}}}, Ts};
    CHECK(f(std::numbers::pi / 14).value() == doctest::Approx(0.87));
}
TEST_CASE("cogging_harmonics: names the field that it refuses") {
    auto p = motor;
    p.pitch = {};
    CHECK(refusal(p) == "cogging_harmonics.pitch = 0 m: must be finite and above 0");
    p = motor, p.harmonics[1].order = 0;
    CHECK(refusal(p) == "cogging_harmonics.order = 0: must be 1 or more");
    p = motor, p.harmonics[1].phase = std::numeric_limits<double>::infinity();
    CHECK(refusal(p) == "cogging_harmonics.phase = inf: must be finite");
    p = motor, p.harmonics[2].amplitude = std::numeric_limits<double>::quiet_NaN() * 1_N;
    CHECK(refusal(p).find("cogging_harmonics.amplitude") == 0);
    CHECK(refusal(motor) == "");
}
