// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/feedforward/cogging_table.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
quantity<si::length> metres(double x) { return quantity<si::length>::from_value(x); }
double wave(double x) { return 20 * std::sin(2 * std::numbers::pi * x / 0.024 + 0.4); }
template <std::size_t Points, std::size_t Order> auto sampled() {
    typename cogging_table<Points, signal::force, Order>::parameters p{.pitch = 24_mm, .points = {}};
    for (std::size_t i = 0; i < Points; ++i) p.points[i] = wave(0.024 * double(i) / Points) * 1_N;
    return cogging_table<Points, signal::force, Order>{p, Ts};
}
template <std::size_t Points, std::size_t Order> double worst() {
    auto f = sampled<Points, Order>();
    double off = 0;
    for (double x = -0.03; x < 0.03; x += 0.0137e-3)
        off = std::max(off, std::abs(f(metres(x)).value() - wave(x)));
    return off / 20;
}
} // namespace

TEST_CASE("cogging_table: through its points, at the seam too: -1 mm on 4 points of 24 mm is 23 mm") {
    cogging_table<4, signal::force, 1> f{{24_mm, {0_N, 6_N, 12_N, 3_N}}, Ts};
    CHECK(f(6_mm) == 6_N);
    CHECK(f(12_mm) == 12_N);
    CHECK(f(9_mm).value() == doctest::Approx(9));
    CHECK(f(21_mm).value() == doctest::Approx(1.5));
    CHECK(f(-3_mm).value() == doctest::Approx(1.5));
    CHECK(f(metres(-0.001)).value() == doctest::Approx(0.5));
    CHECK(f(24_mm) == 0_N);
    cogging_table<4> cubic{{24_mm, {0_N, 6_N, 12_N, 3_N}}, Ts};
    for (int i = -4; i < 8; ++i)
        CHECK(cubic(metres(0.006 * i)).value() ==
              doctest::Approx(f(metres(0.006 * i)).value()).epsilon(1e-12).scale(1));
}
TEST_CASE("cogging_table: a step before the seam is in the last stretch, however small") {
    cogging_table<4> f{{24_mm, {5_N, 6_N, 12_N, 3_N}}, Ts};
    for (const double x : {-1e-18, -1e-30, -5e-324}) CHECK(f(metres(x)).value() == doctest::Approx(5));
}
TEST_CASE("cogging_table: the cubic midway, by hand: 9/16 of either neighbour less 1/16 of the next") {
    cogging_table<4> f{{24_mm, {0_N, 6_N, 12_N, 3_N}}, Ts};
    CHECK(f(9_mm).value() == doctest::Approx((9 * (6 + 12) - 0 - 3) / 16.0));
    CHECK(f(21_mm).value() == doctest::Approx((9 * (3 + 0) - 12 - 6) / 16.0));
}
TEST_CASE("cogging_table: between points a wave is off by b^2/8 (lines) and 3 b^4/128 (cubic) of itself, b = 2 "
          "pi / points") {
    const double b = 2 * std::numbers::pi / 20;
    CHECK(worst<20, 1>() < b * b / 8);
    CHECK(worst<20, 1>() > 0.95 * b * b / 8);
    CHECK(worst<20, 3>() < 3 * std::pow(b, 4) / 128);
    CHECK(worst<20, 3>() > 0.9 * 3 * std::pow(b, 4) / 128);
}
TEST_CASE("cogging_table: repeats every pitch; a million pitches away to 3e-8 N (5 pm on 5 kN/m); beyond all "
          "numbers it holds") {
    auto f = sampled<64, 3>();
    for (double x = 0; x < 0.024; x += 0.5e-3) {
        CHECK(std::abs((f(metres(x + 0.024)) - f(metres(x))).value()) < 1e-11);
        CHECK(std::abs((f(metres(x - 1e6 * 0.024)) - f(metres(x))).value()) < 3e-8);
    }
    const auto last = f(3_mm);
    CHECK(f(metres(1e308)) == last); // 4e309 pitches
    CHECK(f.faulted());
}
TEST_CASE("cogging_table: names the field that it refuses") {
    const auto refusal = [](cogging_table<4>::parameters p) -> std::string {
        try {
            cogging_table<4>{p, Ts};
        } catch (const invalid_parameter& e) {
            return e.what();
        }
        return "";
    };
    CHECK(refusal({}) == "cogging_table.pitch = 0 m: must be finite and above 0");
    CHECK(
        refusal({24_mm, {0_N, std::numeric_limits<double>::quiet_NaN() * 1_N}}).find("cogging_table.points") ==
        0);
    CHECK(refusal({24_mm, {}}) == "");
}
