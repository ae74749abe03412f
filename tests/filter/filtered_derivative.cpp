// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/filtered_derivative.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;
using speed = filtered_derivative<signal::position, signal::velocity>;

TEST_CASE("filtered_derivative: one count of 0.25 um at 2 kHz and 150 Hz reads 0.191 mm/s and fades") {
    speed v{{.corner = 150_Hz}, 500_us};
    CHECK(v(250_nm).value() == doctest::Approx(0.1907e-3).epsilon(1e-3));
    CHECK(v(250_nm).value() == doctest::Approx(0.1907e-3 * 0.6186).epsilon(1e-3));
}
TEST_CASE("filtered_derivative: has the coefficients of scipy") {
    // wc = 2*np.pi*150; scipy.signal.bilinear([wc, 0], [1, wc], fs=2000)
    // -> [762.7573334371064, -762.7573334371064], [1., -0.6186213332814468]
    speed v{{.corner = 150_Hz}, 500_us};
    double x1 = 0, v1 = 0;
    for (int k = 0; k < 200; ++k) {
        const double x = 1e-3 * std::sin(0.1 * k * k);
        const double expected = 762.7573334371064 * (x - x1) + 0.6186213332814468 * v1;
        CHECK(v(x * 1_m).value() == doctest::Approx(expected).epsilon(1e-12).scale(1));
        x1 = x, v1 = expected;
    }
}
TEST_CASE("filtered_derivative: the formula of docs/formats.md, bit for bit up to two roundings a step") {
    const double wc = 2 * std::numbers::pi * 227.731, T = 500e-6;
    speed v{{.corner = 227.731 * 1_Hz}, 500_us};
    double y1 = 0, v1 = 0;
    for (int k = 0; k < 5000; ++k) {
        const double y = 250e-9 * std::round(4e4 * std::sin(0.003 * k)); // counts
        v1 = ((2 - wc * T) * v1 + 2 * wc * (y - y1)) / (2 + wc * T);
        y1 = y;
        CHECK(std::abs(v(y * 1_m).value() - v1) <= 1e-15); // [m/s]; one count is 0.5e-3
    }
}
TEST_CASE("filtered_derivative: a ramp is read exactly, whatever the corner") {
    for (const double corner : {1.0, 150.0, 636.0, 5000.0}) {
        speed v{{.corner = corner * 1_Hz}, 500_us};
        v.settle(0_m, 20_mmps);
        for (int k = 1; k < 100; ++k) CHECK(v(k * 10e-6 * 1_m).value() == doctest::Approx(20e-3).epsilon(1e-9));
    }
}
TEST_CASE("filtered_derivative: above the sampling rate over pi it rings but decays") {
    speed v{{.corner = 5000_Hz}, 500_us};
    const double first = v(1_um).value(), second = v(1_um).value();
    CHECK(first * second < 0);
    for (int k = 0; k < 1000; ++k) v(1_um);
    CHECK(std::abs(v(1_um).value()) < 1e-12 * first);
}
TEST_CASE("filtered_derivative: refuses a corner that is not above 0") {
    CHECK_THROWS_WITH_AS((speed{{.corner = 0_Hz}, 1_ms}),
                         "filtered_derivative.corner = 0 Hz: must be finite and above 0", invalid_parameter);
}
