// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/backward_difference.hpp>
#include <quadrant/filter/two_sample_derivative.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>

using namespace quadrant;
using namespace quadrant::literals;
using speed = two_sample_derivative<signal::position, signal::velocity>;

TEST_CASE("two_sample_derivative: one count of 0.25 um at 2 kHz reads 0.25 mm/s, twice") {
    speed v{{}, 500_us};
    CHECK(v(250_nm).value() == doctest::Approx(0.25e-3).epsilon(1e-12));
    CHECK(v(250_nm).value() == doctest::Approx(0.25e-3).epsilon(1e-12));
    CHECK(v(250_nm).value() == 0);
}
TEST_CASE("two_sample_derivative: is the backward difference of the mean of two samples") {
    speed v{{}, 500_us};
    backward_difference<signal::position, signal::velocity> difference{{}, 500_us};
    auto before = 0_m;
    for (int k = 0; k < 200; ++k) {
        const auto y = 1e-3 * std::sin(0.1 * k * k) * 1_m;
        CHECK(v(y).value() == doctest::Approx(difference(0.5 * (y + before)).value()).epsilon(1e-12).scale(1));
        before = y;
    }
}
TEST_CASE("two_sample_derivative: a parabola reads its slope one period late, exactly") {
    speed v{{}, 500_us};
    const auto x = [](double t) { return 1.5 * t * t * 1_m; };
    for (int k = 0; k < 100; ++k) {
        const double read = v(x(k * 500e-6)).value();
        if (k >= 2) CHECK(read == doctest::Approx(3.0 * (k - 1) * 500e-6).epsilon(1e-9));
    }
}
TEST_CASE("two_sample_derivative: its delay is one period at all frequencies") {
    const speed v{{}, 500_us};
    for (const double f : {10.0, 100.0, 500.0, 900.0}) {
        const auto advanced = v.response(f * 1_Hz) * std::polar(1.0, 2 * std::numbers::pi * f * 500e-6);
        CHECK(std::abs(advanced.real()) <= 1e-9 * std::abs(advanced)); // what is left is i times a real gain
        CHECK(advanced.imag() > 0);
    }
    CHECK(std::abs(v.response(1000_Hz)) < 1e-9);
}
TEST_CASE("two_sample_derivative: moving on at the settled rate keeps it from the first sample on") {
    speed v{{}, 500_us};
    v.settle(10_mm, 20_mmps);
    for (int k = 1; k < 10; ++k)
        CHECK(v(10_mm + k * 10e-6 * 1_m).value() == doctest::Approx(20e-3).epsilon(1e-10));
}
