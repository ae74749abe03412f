// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/backward_difference.hpp>
#include <quadrant/filter/edge_velocity.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration T = 500_us;
using speed = edge_velocity<signal::position, signal::velocity>;
/// The encoder: the nearest count.
double read(double x, double step) { return std::round(x / step) * step; }
double decades(std::mt19937& engine, double low, double high) {
    return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(engine));
}
} // namespace

TEST_CASE(
    "edge_velocity: at a constant speed it is off by at most |v| T / window, at every sample and any speed") {
    std::mt19937 engine(1);
    int broken = 0, samples = 0;
    double most = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const double step = decades(engine, 1e-7, 1e-4), window = decades(engine, 1, 50) * T.value(),
                     v = (trial % 2 ? 1 : -1) * decades(engine, 1e-2, 30) * step / T.value(),
                     start = std::uniform_real_distribution<double>(-1, 1)(engine) * step;
        speed estimate({step * 1_m, window * 1_s, 200.0 * T + window * 1_s}, T);
        estimate.settle(read(start, step) * 1_m);
        // From the third edge behind a window on: the first is the reference, the second may come too soon.
        const int known =
            2 + int(2 * std::max(window, std::abs(step / v)) / T.value()) + int(std::abs(step / v) / T.value());
        for (int k = 1; k < known + 520; ++k) {
            const double is = estimate(read(start + v * k * T.value(), step) * 1_m).value();
            if (k <= known) continue;
            const double off = std::abs(is - v), bound = std::abs(v) * T.value() / window;
            broken += !(off <= bound * (1 + 1e-6) + 1e-12 * std::abs(v));
            most = std::max(most, off / bound);
            ++samples;
        }
    }
    CHECK(samples > 1'000'000);
    CHECK(broken == 0);
    CHECK(most > 0.8); // close to the bound
}

TEST_CASE("edge_velocity: with the age of each edge a constant speed is read to rounding") {
    std::mt19937 engine(2);
    double most = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const double step = 1e-5, v = decades(engine, 0.02, 5) * step / T.value();
        speed estimate({step * 1_m, 5.0 * T, 500.0 * T}, T);
        const int known = 12 + int(3 * step / v / T.value());
        for (int k = 1; k < known + 300; ++k) {
            const double x = v * k * T.value(), crossed = (std::floor(x / step - 0.5) + 0.5) * step;
            const double is = estimate(read(x, step) * 1_m, (x - crossed) / v * 1_s).value();
            if (k > known) most = std::max(most, std::abs(is / v - 1));
        }
    }
    CHECK(most < 1e-9);
}

TEST_CASE(
    "edge_velocity: between edges it is never faster than one count since the last edge, and zero after rest") {
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    const double step = 1e-6;
    speed estimate({step * 1_m, 4.0 * T, 100.0 * T}, T);
    int broken = 0, resting = 0;
    double x = 0, v = 0, before = 0;
    int since = 0;
    for (int k = 0; k < 1'000'000; ++k) {
        v = k % 5000 < 4000 ? 0.999 * v + 0.02 * step / T.value() * unit(engine)
                            : 0; // wanders, then stands still
        x += v * T.value();
        const double at = read(x, step), is = estimate(at * 1_m).value();
        since = at != before ? 0 : since + 1;
        if (since > 0) broken += !(std::abs(is) <= step / (since * T.value()) * (1 + 1e-12));
        if (since > 100) broken += is != 0, ++resting;
        before = at;
    }
    CHECK(broken == 0);
    CHECK(resting > 100'000);
    CHECK_FALSE(estimate.faulted());
}

TEST_CASE("edge_velocity: an axis that trembles across one edge is at rest, where a difference reads a count a "
          "sample") {
    speed estimate({1_um, 1_ms, 1_s}, T);
    backward_difference<signal::position, signal::velocity> difference({}, T);
    double most = 0, jumps = 0;
    for (int k = 0; k < 1000; ++k) {
        const auto at = double((k / 3) % 2) * 1.0_um;
        most = std::max(most, std::abs(estimate(at).value()));
        jumps = std::max(jumps, std::abs(difference(at).value()));
    }
    CHECK(most == 0);
    CHECK(jumps == doctest::Approx(2e-3));
}

TEST_CASE("edge_velocity: 0.1 mm/s on counts of 1 um at 2 kHz reads within 5 %, where a difference reads 0 or "
          "2 mm/s") {
    speed estimate({1_um, 10_ms, 100_ms}, T);
    backward_difference<signal::position, signal::velocity> difference({}, T);
    double low = 1, high = 0, most = 0;
    for (int k = 0; k < 4000; ++k) {
        const auto at = read(1e-4 * k * T.value(), 1e-6) * 1_m;
        const double is = estimate(at).value();
        most = std::max(most, difference(at).value());
        if (k > 100) low = std::min(low, is), high = std::max(high, is);
    }
    CHECK(low >= 0.95e-4);
    CHECK(high <= 1.05e-4);
    CHECK(most == doctest::Approx(2e-3));
}

TEST_CASE("edge_velocity: settle goes on at a speed, shift moves no speed, retune keeps what was measured") {
    speed estimate({1_um, 1_ms, 1_s}, T);
    estimate.settle(3_um, 0.5_mmps);
    CHECK(estimate(3_um) == 0.5_mmps);
    estimate.shift(1_mm);
    CHECK(estimate(1_mm + 3_um) == 0.5_mmps);
    estimate.retune(speed({1_um, 2_ms, 2_s}, T));
    CHECK(estimate(1_mm + 3_um) == 0.5_mmps);
    CHECK(estimate.given().window == 2_ms);
    estimate.retune(speed({1_um, 2_ms, 2_s}, 1_ms));
    CHECK(estimate.faulted());
    CHECK_THROWS_WITH_AS(speed({1_um, 0.4_ms, 1_s}, T),
                         "edge_velocity.window = 4e-04 s: must be finite and not below the period (5e-04 s)",
                         invalid_parameter);
}
