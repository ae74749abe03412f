// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/transfer_function.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace quadrant;
using namespace quadrant::literals;
using resonance = notch<signal::force>;

TEST_CASE("notch: has the coefficients of scipy") {
    // w = 2*np.pi*330; k = w/np.tan(w*5e-4/2); scipy.signal.bilinear([1,0,w*w], [1,.1*w,w*w], fs=k/2)
    const transfer_function<signal::force, signal::force, 2>::parameters scipy{
        {0.9587386668273964, -0.9760753765928832, 0.9587386668273964},
        {1, -0.9760753765928832, 0.9174773336547929}};
    transfer_function<signal::force, signal::force, 2> reference{scipy, 500_us};
    resonance n{{.centre = 330_Hz, .width = 0.1}, 500_us};
    for (int k = 0; k < 500; ++k) {
        const auto x = std::sin(0.01 * k * k) * 100_N;
        CHECK(std::abs((n(x) - reference(x)).value()) < 1e-10); // [N] of 100
    }
}
TEST_CASE("notch: width 0.06 at 330 Hz leaves 0.967 at 300 Hz") {
    // abs(scipy.signal.freqz(*scipy.signal.bilinear([1,0,w*w], [1,.06*w,w*w], fs=k/2), worN=[300], fs=2000)[1])
    const resonance n{{.centre = 330_Hz, .width = 0.06}, 500_us};
    CHECK(std::abs(n.response(300_Hz)) == doctest::Approx(0.9665633045301874).epsilon(1e-12));
}
TEST_CASE("notch: zero exactly at the centre, up to half the sampling rate") {
    for (const double centre : {1.0, 30.0, 330.0, 900.0, 990.0}) {
        const resonance n{{.centre = centre * 1_Hz, .width = 0.1}, 500_us};
        CHECK(std::abs(n.response(centre * 1_Hz)) < 1e-9);
    }
}
TEST_CASE("notch: unity gain at standstill, at half the sampling rate and one decade away") {
    const resonance n{{.centre = 100_Hz, .width = 0.1}, 500_us};
    CHECK(std::abs(n.response(0_Hz)) == doctest::Approx(1).epsilon(1e-12));
    CHECK(std::abs(n.response(1000_Hz)) == doctest::Approx(1).epsilon(1e-12));
    CHECK(std::abs(n.response(10_Hz)) == doctest::Approx(1).epsilon(1e-4));
}
TEST_CASE("notch: -3 dB where the band of width times centre ends") {
    const resonance n{{.centre = 20_Hz, .width = 0.1}, 500_us}; // slow: no warp to speak of
    const double half = 20 * 0.1 / 2;
    for (const double f : {std::sqrt(400 + half * half) - half, std::sqrt(400 + half * half) + half})
        CHECK(std::norm(n.response(f * 1_Hz)) == doctest::Approx(0.5).epsilon(1e-3));
}
TEST_CASE("notch: in float too the gain at standstill is one, however low the centre") {
    for (const double centre : {0.5, 5.0, 50.0}) {
        notch<signal::force, float> n{{.centre = centre * 1_Hz, .width = 0.1}, 125_us};
        const auto x = quantity_of<signal::force, float>::from_value(100);
        n.settle(x);
        CHECK(n(x).value() == doctest::Approx(100).epsilon(1e-6));
    }
}
TEST_CASE("notch: refuses a centre at or above half the sampling rate, and a width of 0") {
    CHECK_THROWS_WITH_AS((resonance{{.centre = 1200_Hz}, 500_us}),
                         "notch.centre = 1200 Hz: must lie between 0 and half the sampling rate (1000 Hz)",
                         invalid_parameter);
    CHECK_THROWS_WITH_AS((resonance{{.centre = 330_Hz, .width = 0}, 500_us}),
                         "notch.width = 0: must be finite and above 0", invalid_parameter);
}
