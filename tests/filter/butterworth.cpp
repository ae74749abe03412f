// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/transfer_function.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace quadrant;
using namespace quadrant::literals;
using smooth = butterworth<signal::force>;

TEST_CASE("butterworth: at 8 kHz with a corner of 100 Hz, 1 kHz comes through at 0.0090") {
    // abs(scipy.signal.freqz(*scipy.signal.butter(2, 100, fs=8000), worN=[1000], fs=8000)[1])
    const smooth f{{.corner = 100_Hz}, 125_us};
    CHECK(std::abs(f.response(1_kHz)) == doctest::Approx(0.00899705169435948).epsilon(1e-12));
}
TEST_CASE("butterworth: has the coefficients of scipy") {
    // scipy.signal.butter(2, 100, fs=2000)
    transfer_function<signal::force, signal::force, 2> scipy{
        {{0.02008336556421124, 0.04016673112842247, 0.02008336556421124},
         {1, -1.5610180758007182, 0.6413515380575631}},
        500_us};
    smooth f{{.corner = 100_Hz}, 500_us};
    for (int k = 0; k < 500; ++k) {
        const auto x = std::sin(0.01 * k * k) * 100_N;
        CHECK(std::abs((f(x) - scipy(x)).value()) < 1e-11); // [N] of 100
    }
}
TEST_CASE("butterworth: -3 dB and -90 degrees exactly at the corner") {
    for (const double corner : {1.0, 100.0, 700.0}) {
        const smooth f{{.corner = corner * 1_Hz}, 500_us};
        const auto h = f.response(corner * 1_Hz);
        CHECK(std::norm(h) == doctest::Approx(0.5).epsilon(1e-9));
        CHECK(std::arg(h) == doctest::Approx(-std::numbers::pi / 2).epsilon(1e-9));
    }
}
TEST_CASE("butterworth: flat below the corner: no frequency comes out larger") {
    const smooth f{{.corner = 100_Hz}, 500_us};
    for (double hz = 1; hz < 1000; hz += 1) CHECK(std::abs(f.response(hz * 1_Hz)) <= 1 + 1e-12);
}
TEST_CASE("butterworth: a step overshoots by 4.3 %") {
    smooth f{{.corner = 10_Hz}, 125_us};
    double most = 0;
    for (int k = 0; k < 4000; ++k) most = std::max(most, f(1_N).value());
    CHECK(most == doctest::Approx(1 + std::exp(-std::numbers::pi)).epsilon(1e-4));
}
TEST_CASE("butterworth: a constant arrives as it is, in float at a corner of 1 Hz too") {
    butterworth<signal::force, float> f{{.corner = 1_Hz}, 125_us};
    const auto x = quantity_of<signal::force, float>::from_value(100);
    f.settle(x);
    for (int k = 0; k < 10000; ++k) f(x);
    CHECK(f(x).value() == doctest::Approx(100).epsilon(1e-5));
}
TEST_CASE("butterworth: refuses a corner of 0") {
    CHECK_THROWS_WITH_AS((smooth{{.corner = 0_Hz}, 500_us}),
                         "butterworth.corner = 0 Hz: must lie between 0 and half the sampling rate (1000 Hz)",
                         invalid_parameter);
}
