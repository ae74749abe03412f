// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/loop.hpp>
#include <quadrant/analysis/nyquist.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

using namespace quadrant::literals;
namespace qa = quadrant::analysis;
using qa::hertz;
using quadrant::invalid_parameter;

TEST_CASE("nyquist: a loop of third order loses two poles at the gain of Routh's criterion") {
    for (const auto& [k, count] : {std::pair{0.5, 0}, {5.9, 0}, {6.1, 2}, {60.0, 2}}) { // s^3 + 3 s^2 + 2 s + K
        const auto l = [k = k](quadrant::frequency f) {
            const auto s = qa::laplace(f);
            return k / (s * (s + 1.0) * (s + 2.0));
        };
        CHECK(qa::unstable_poles(l, {0.001_Hz, 100_Hz}, 1) == count);
    }
}
TEST_CASE("nyquist: a conditionally stable loop needs its gain") {
    for (const auto& [k, count] : {std::pair{0.49, 2}, {0.51, 0}, {5.0, 0}}) { // s^3 + K (s + 1)^2: K > 1/2
        const auto l = [k = k](quadrant::frequency f) {
            const auto s = qa::laplace(f);
            return k * (s + 1.0) * (s + 1.0) / (s * s * s);
        };
        CHECK(qa::unstable_poles(l, {0.001_Hz, 100_Hz}, 3) == count);
    }
}
TEST_CASE("nyquist: dead time makes a pair of poles unstable each time its phase passes") {
    // s + w e^{-sT}: roots cross the axis at w T = pi/2 + 2 pi n, a pair each
    for (const auto& [wt, count] : {std::pair{1.5, 0}, {1.6, 2}, {7.8, 2}, {7.9, 4}, {14.2, 6}}) {
        const auto l = [wt = wt](quadrant::frequency f) {
            const auto s = qa::laplace(f);
            return wt * std::exp(-s) / s;
        };
        CHECK(qa::unstable_poles(l, {0.01_Hz, 10_Hz}, 1) == count);
    }
}
TEST_CASE("nyquist: a lightly damped mode above one makes its pair unstable though the margins' first crossing "
          "is good") {
    const auto with = [](double high) {
        return [high](quadrant::frequency f) {
            const auto s = qa::laplace(f);
            const double w0 = 2 * std::numbers::pi * 10, w = 2 * std::numbers::pi * 112;
            return w0 / s * (1.0 + high * w * w / (s * s + 0.004 * w * s + w * w)) * std::exp(-s * 1e-3);
        };
    };
    CHECK(qa::unstable_poles(with(0.01), {0.5_Hz, 900_Hz}, 1) == 0);
    CHECK(qa::unstable_poles(with(0.3), {0.5_Hz, 900_Hz}, 1) == 2);
    CHECK(qa::unstable_poles(with(-0.3), {0.5_Hz, 900_Hz}, 1) == 0);     // as high, but away from -1
    CHECK(qa::margins(with(0.3), {0.5_Hz, 900_Hz}).phase()->value > 60); // at 10 Hz
}
TEST_CASE("nyquist: a sampled loop is judged up to half the sampling rate") {
    // z^2 - z + g (one sample of delay, integrator): both poles leave the circle at g = 1
    for (const auto& [g, count] : {std::pair{0.9, 0}, {0.99, 0}, {1.01, 2}, {1.5, 2}}) {
        const auto l = [g = g](quadrant::frequency f) {
            const auto back = std::exp(-qa::laplace(f) * 1e-3);
            return g * back * back / (1.0 - back);
        };
        CHECK(qa::unstable_poles(l, {1_Hz, 499.9_Hz}, 1) == count);
    }
}
TEST_CASE("nyquist: what the band does not show is refused") {
    const auto l = [](quadrant::frequency f) { return 10.0 / qa::laplace(f); };
    CHECK_THROWS_AS(qa::unstable_poles(l, {10_Hz, 100_Hz}, 1), invalid_parameter); // |L| below one
    CHECK_THROWS_AS(qa::unstable_poles(l, {0.01_Hz, 1_Hz}, 1), invalid_parameter); // ... and above
    CHECK_THROWS_AS(qa::unstable_poles(l, {0.01_Hz, 100_Hz}, 9), invalid_parameter);
    const auto reversed = [](quadrant::frequency f) { return -10.0 / qa::laplace(f); };
    CHECK_THROWS_AS(qa::unstable_poles(reversed, {0.01_Hz, 100_Hz}, 1), invalid_parameter);
}
