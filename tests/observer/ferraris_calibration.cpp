// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/ferraris_calibration.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
using analysis::calibrate_ferraris;
using analysis::ferraris_calibration;
namespace {
using doctest::Approx;
using std::numbers::pi;
const duration T = 500_us;
constexpr double G = 32.98, Z = -8.58e-3; // [Jamaludin2008] Appendix B: 3.298e7 um/(V s^2), -8580 um/s^2

struct record {
    std::vector<quantity_of<signal::position>> position;
    std::vector<quantity_of<signal::voltage>> sensor;
    ferraris_calibration fit() const { return calibrate_ferraris(position, sensor, T); }
};
/// Sines of 0.5 and 4 Hz seen by an encoder of 0.25 um, started in the middle of the motion, the axis not at
/// zero.
record run(double step, double noise, double amplitude = 5e-3, std::uint32_t seed = 3) {
    record r;
    std::mt19937 bits(seed);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 8000; ++k) {
        const double t = k * T.value(), w = 2 * pi * 0.5, o = 2 * pi * 4;
        const double x = 0.1 + 0.02 * std::sin(w * t + 1) + amplitude * std::sin(o * t);
        const double a = -0.02 * w * w * std::sin(w * t + 1) - amplitude * o * o * std::sin(o * t);
        r.position.push_back((step > 0 ? step * std::round(x / step) : x) * 1_m);
        r.sensor.push_back(((a - Z) / G + noise * normal(bits)) * 1_V);
    }
    return r;
}
} // namespace

TEST_CASE("ferraris_calibration: finds the thesis' gain and offset, and where the record started") {
    const auto c = run(0, 0).fit();
    CHECK(c.determined());
    CHECK(c.gain.value() == Approx(G).epsilon(3e-5)); // (w T)^2 / 12 at 4 Hz: 1.3e-5
    CHECK(c.offset.value() == Approx(Z).epsilon(1e-3).scale(0));
    CHECK(c.residual.value() < 0.1e-6); // m; the double integral is that of straight lines, not a sample late
    CHECK(c.start_position.value() == Approx(0.1 + 0.02 * std::sin(1)).epsilon(1e-5).scale(0));
    const double v0 = 0.02 * pi * std::cos(1) + 5e-3 * 8 * pi;
    CHECK(c.start_velocity.value() == Approx(v0).epsilon(1e-4).scale(0));
    CHECK(c.acceleration(0.01_V).value() == Approx(0.01 * G + Z).epsilon(1e-4).scale(0));
}
TEST_CASE(
    "ferraris_calibration: whole periods of a sine are excitation but for what a parabola follows of them") {
    record r;
    for (int k = 0; k < 8000; ++k) { // 16 periods
        const double w = 2 * pi * 4, x = 5e-3 * std::cos(w * k * T.value());
        r.position.push_back((0.1 + x) * 1_m), r.sensor.push_back(-w * w * x / G * 1_V);
    }
    CHECK(r.fit().excitation.value() == Approx(5e-3 / std::sqrt(2)).epsilon(0.01).scale(0));
}
TEST_CASE("ferraris_calibration: behind an encoder of 0.25 um the deviations that it states are the scatter of "
          "its results") {
    // The phase of the grid against the motion is what differs between the records.
    double gain = 0, offset = 0, stated = 0, stated_offset = 0;
    constexpr int records = 40;
    const auto exact = run(0, 0).fit();
    for (int i = 0; i < records; ++i) {
        record r = run(0, 0, 5e-3);
        std::mt19937 bits(std::uint32_t(i) + 1);
        std::normal_distribution<double> normal;
        for (auto& x : r.position) x += 1e-6 * normal(bits) * 1_m;
        const auto c = r.fit();
        gain += std::pow((c.gain - exact.gain).value(), 2) / records;
        offset += std::pow((c.offset - exact.offset).value(), 2) / records;
        stated += c.gain_deviation.value() / records;
        stated_offset += c.offset_deviation.value() / records;
    }
    CHECK(std::sqrt(gain) ==
          Approx(stated).epsilon(0.35).scale(0)); // 40 records: 11 % in a deviation, times three
    CHECK(std::sqrt(offset) == Approx(stated_offset).epsilon(0.35).scale(0));
    const auto stepped = run(0.25e-6, 0).fit();
    CHECK(stepped.residual.value() < 1e-6);
    CHECK(std::abs(stepped.gain.value() - G) < 5e-4 * G);
}
TEST_CASE("ferraris_calibration: a record without changing acceleration cannot distinguish gain and offset, "
          "and says so") {
    record still;
    for (int k = 0; k < 4000; ++k) {
        const double t = k * T.value();
        still.position.push_back((0.1 + 0.02 * t + 0.25 * t * t) * 1_m); // 0.5 m/s^2 throughout
        still.sensor.push_back((0.5 - Z) / G * 1_V);
    }
    CHECK_FALSE(still.fit().determined());
    record dead = run(0.25e-6, 0);
    for (auto& m : dead.sensor) m = 0_V; // the cable is off
    const auto c = dead.fit();
    CHECK_FALSE(c.determined());
    CHECK(std::isfinite(c.gain.value()));
}
TEST_CASE("ferraris_calibration: refuses records that do not match, are too short, or hold no numbers") {
    record r = run(0, 0);
    CHECK_THROWS_AS(calibrate_ferraris(r.position, r.sensor, 0_s), invalid_parameter);
    r.sensor.pop_back();
    CHECK_THROWS_WITH_AS(
        r.fit(), "calibrate_ferraris.samples = 7999: must be as many for the sensor as for the position (8000)",
        invalid_parameter);
    r = run(0, 0);
    r.sensor[17] = std::nan("") * 1_V;
    CHECK_THROWS_WITH_AS(r.fit(), "calibrate_ferraris.sensor = nan V: must be finite", invalid_parameter);
    CHECK_THROWS_AS(record{}.fit(), invalid_parameter);
}
