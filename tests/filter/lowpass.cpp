// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/lowpass.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace quadrant;
using namespace quadrant::literals;
using smooth = lowpass<signal::force>;

TEST_CASE("lowpass: at 8 kHz with a corner of 100 Hz, 1 kHz comes through at 0.0944") {
    // abs(scipy.signal.freqz(*scipy.signal.butter(1, 100, fs=8000), worN=[1000], fs=8000)[1])
    const smooth f{{.corner = 100_Hz}, 125_us};
    CHECK(std::abs(f.response(1_kHz)) == doctest::Approx(0.09443084370819936).epsilon(1e-12));
}
TEST_CASE("lowpass: has the coefficients of scipy") {
    // scipy.signal.butter(1, 100, fs=2000) -> [0.13672873599731955]*2, [1, -0.726542528005361]
    smooth f{{.corner = 100_Hz}, 500_us};
    double x1 = 0, y1 = 0;
    for (int k = 0; k < 500; ++k) {
        const double x = 100 * std::sin(0.01 * k * k);
        y1 = 0.13672873599731955 * (x + x1) + 0.726542528005361 * y1;
        x1 = x;
        CHECK(std::abs(f(x * 1_N).value() - y1) < 1e-11); // [N] of 100
    }
}
TEST_CASE("lowpass: -3 dB and -45 degrees exactly at the corner, nothing at half the sampling rate") {
    for (const double corner : {1.0, 100.0, 700.0}) {
        const smooth f{{.corner = corner * 1_Hz}, 500_us};
        const auto h = f.response(corner * 1_Hz);
        CHECK(std::norm(h) == doctest::Approx(0.5).epsilon(1e-12));
        CHECK(std::arg(h) == doctest::Approx(-std::numbers::pi / 4).epsilon(1e-12));
        CHECK(std::abs(f.response(1000_Hz)) < 1e-12);
    }
}
TEST_CASE("lowpass: a constant arrives as it is, in float at a corner of 0.1 Hz too") {
    lowpass<signal::force, float> f{{.corner = 0.1_Hz}, 125_us};
    const auto x = quantity_of<signal::force, float>::from_value(100);
    f.settle(x);
    for (int k = 0; k < 10000; ++k) f(x);
    CHECK(f(x) == x);
}
TEST_CASE("lowpass: refuses a corner at half the sampling rate") {
    CHECK_THROWS_WITH_AS((smooth{{.corner = 1000_Hz}, 500_us}),
                         "lowpass.corner = 1000 Hz: must lie between 0 and half the sampling rate (1000 Hz)",
                         invalid_parameter);
}
