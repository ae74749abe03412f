// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/plant/cogging_force.hpp>
#include <quadrant/plant/force_ripple.hpp>

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
const cogging_force<3>::parameters magnets{30_mm, {8_N, -3_N, 1_N}, {0.4, -2.0, 1.0}};

double printed(double x) { // the equation of docs/formats.md, term by term
    return 8 * std::sin(2 * pi * x / 0.03 + 0.4) - 3 * std::sin(4 * pi * x / 0.03 - 2.0) +
           std::sin(6 * pi * x / 0.03 + 1.0);
}
} // namespace

TEST_CASE("cogging_force: the sum of sines over the position, to 1e-12 N within and 1e-9 N a kilometre away") {
    cogging_force<3> force{magnets, T};
    for (int i = -400; i < 400; ++i) {
        const double x = i * 0.7e-3;
        CHECK(std::abs(force(x * 1_m).value() - printed(x)) < 1e-12);
        CHECK(std::abs(force((x + 1000.02) * 1_m).value() - printed(x + 0.02 + 1000 - 0.03 * 33333)) < 1e-9);
    }
}

TEST_CASE("cogging_force: does no work over a whole period, one mean value for both directions") {
    cogging_force<3> force{magnets, T};
    double sum = 0;
    for (int i = 0; i < 1000; ++i) sum += force(i * 0.03e-3 * 1_m).value();
    CHECK(std::abs(sum / 1000) < 1e-12);
}

TEST_CASE("cogging_force: a dual has the slope over position, period, size and phase") {
    using D = dual<4>;
    using length = quantity_of<signal::position, D>;
    const auto at = [](double x, double period, double size, double phase) {
        return size * std::sin(2 * pi * x / period + phase);
    };
    cogging_force<1, D> force{{length::from_value(D::variable(0.03, 1)),
                               {quantity_of<signal::force, D>::from_value(D::variable(8, 2))},
                               {D::variable(0.4, 3)}},
                              T};
    const D got = force(length::from_value(D::variable(0.047, 0))).value();
    CHECK(got.value == Approx(at(0.047, 0.03, 8, 0.4)).epsilon(1e-12));
    const double h = 1e-6;
    CHECK(got.partial[0] ==
          Approx((at(0.047 + h, 0.03, 8, 0.4) - at(0.047 - h, 0.03, 8, 0.4)) / (2 * h)).epsilon(1e-6));
    CHECK(got.partial[1] ==
          Approx((at(0.047, 0.03 + h, 8, 0.4) - at(0.047, 0.03 - h, 8, 0.4)) / (2 * h)).epsilon(1e-6));
    CHECK(got.partial[2] == Approx(std::sin(2 * pi * 0.047 / 0.03 + 0.4)).epsilon(1e-9));
    CHECK(got.partial[3] == Approx(8 * std::cos(2 * pi * 0.047 / 0.03 + 0.4)).epsilon(1e-9));
}

TEST_CASE("cogging_force, force_ripple: refuse a period of zero, a ripple of the whole force, and no numbers") {
    const auto words = [](auto make, const char* said) {
        CHECK_THROWS_WITH_AS(make(), said, invalid_parameter);
    };
    words(
        [] {
            cogging_force<1>{{0_mm, {1_N}, {0.0}}, T};
        },
        "cogging_force.period = 0 m: must be finite and above 0");
    words(
        [] {
            cogging_force<1>{{30_mm, {std::nan("") * 1_N}, {0.0}}, T};
        },
        "cogging_force.size = nan N: must be finite");
    words(
        [] {
            cogging_force<1>{{30_mm, {1_N}, {std::nan("")}}, T};
        },
        "cogging_force.phase = nan: must be finite");
    words(
        [] {
            cogging_force<1>{{30_mm, {1_N}, {0.0}}, 0_s};
        },
        "cogging_force.sample_period = 0 s: must be finite and above 0");
    words(
        [] {
            force_ripple<signal::force, 2>{{30_mm, {0.5, -0.5}, {}}, T};
        },
        "force_ripple.size = 1: must sum up to less than 1");
    words(
        [] {
            force_ripple<>{{-30_mm, {0.1}, {}}, T};
        },
        "force_ripple.period = -0.03 m: must be finite and above 0");
}

TEST_CASE("force_ripple: 5 % of ripple give 105 N of 100 N at its crest and 95 N half a period on") {
    force_ripple<> ripple{{30_mm, {0.05}, {pi / 2}}, T};
    CHECK(ripple(100_N, 0_m).value() == Approx(105).epsilon(1e-12));
    CHECK(ripple(100_N, 15_mm).value() == Approx(95).epsilon(1e-12));
    CHECK(ripple(-100_N, 15_mm).value() == Approx(-95).epsilon(1e-12));
    CHECK(ripple(0_N, 3_mm).value() == 0); // no command, no force
    CHECK(ripple(1_N).value() ==
          Approx(1 + 0.05 * std::sin(0.2 * pi + pi / 2)).epsilon(1e-12)); // stays at 3 mm
    CHECK(ripple.response(10_Hz).real() == Approx(1 + 0.05 * std::sin(0.2 * pi + pi / 2)).epsilon(1e-12));
    const auto held = ripple(2_N, 7_mm);
    CHECK(ripple(2_N, std::nan("") * 1_m) == held);
    CHECK(ripple.faulted());
    CHECK(ripple.now().position == 7_mm);
}
