// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/plant/three_phase_drive.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto T = 2_ms;
three_phase_drive<>::parameters stage() {
    return {.force_constant = 40_N / 1_A,
            .resistance = 2_V / 1_A,
            .time_constant = 4_ms,
            .pole_pair = 30_mm,
            .bus = 150_V,
            .current_limit = 8_A,
            .bandwidth = 300_Hz,
            .steps = 20};
}
double mean_after(three_phase_drive<>& drive, double amps, double speed, int settle, int samples,
                  std::complex<double>* ripple = nullptr, double waves = 0) {
    double x = 0, sum = 0;
    std::complex<double> turning = 0;
    for (int k = 0; k < settle + samples; ++k, x += speed * T.value()) {
        const double f = drive(amps * 1_A, x * 1_m, speed * 1_mps).value();
        if (k < settle) continue;
        sum += f / samples;
        const double middle = x + speed * T.value() / 2;
        turning += 2.0 / samples * f * std::polar(1.0, -waves * 2 * std::numbers::pi * middle / 30e-3);
    }
    if (ripple != nullptr) *ripple = turning;
    return sum;
}
} // namespace

TEST_CASE("three_phase_drive: a locked axis follows its command with the lag of the current loop") {
    // The mean over a period of kf I (1 - exp(-w t)); half a step of delay by sampling is the rest.
    auto p = stage();
    p.steps = 1000, p.bandwidth = 100_Hz;
    three_phase_drive<> drive(p, T);
    const double w = 2 * std::numbers::pi * 100;
    for (int k = 0; k < 4; ++k) {
        const double a = k * 2e-3, b = a + 2e-3;
        const double expected = 40 * 3 * (1 + (std::exp(-w * b) - std::exp(-w * a)) / (w * 2e-3));
        CHECK(std::abs(drive(3_A).value() - expected) < 0.1); // of 120
    }
}
TEST_CASE("three_phase_drive: force is force constant times current anywhere, with the bus far away") {
    three_phase_drive<> drive(stage(), T);
    for (const double x : {0.0, 3e-3, 11e-3, 24e-3}) {
        drive.reset();
        double f = 0;
        for (int k = 0; k < 50; ++k) f = drive(-2_A, x * 1_m).value();
        CHECK(f == doctest::Approx(-80).epsilon(1e-9));
        drive.settle(-2_A, x * 1_m);
        CHECK(drive(-2_A, x * 1_m).value() == doctest::Approx(-80).epsilon(1e-9));
    }
}
TEST_CASE("three_phase_drive: magnets taken for elsewhere cost the cosine") {
    auto p = stage();
    p.commutation_offset = 0.5;
    three_phase_drive<> drive(p, T);
    CHECK(mean_after(drive, 3, 0, 50, 1) == doctest::Approx(120 * std::cos(0.5)).epsilon(1e-9));
}
TEST_CASE(
    "three_phase_drive: a sensor 3 % off makes ripple of twice the pole pair, an offset of once, as computed") {
    // i_a = -I sin: read (1 + g) i_a, both PI see what they want, so i_q is off by g I/2 (1 - cos 2a) - g I/(2
    // sqrt 3) sin 2a.
    auto p = stage();
    p.gain_error = 0.03;
    three_phase_drive<> drive(p, T);
    std::complex<double> ripple;
    const double speed = 1e-3; // so slow that the loop follows; 150 samples are 0.3 mm
    const double mean = mean_after(drive, 3, speed, 100, 15000, &ripple, 2);
    CHECK(mean == doctest::Approx(120 * (1 - 0.015)).epsilon(0.001));
    CHECK(std::abs(ripple) == doctest::Approx(120 * 0.03 / std::sqrt(3.0)).epsilon(0.03));
    p.gain_error = 0, p.current_offset = 0.1_A;
    three_phase_drive<> shifted(p, T);
    mean_after(shifted, 3, speed, 100, 15000, &ripple, 1);
    CHECK(std::abs(ripple) == doctest::Approx(40 * 0.1 * 2 / std::sqrt(3.0)).epsilon(0.01));
}
TEST_CASE("three_phase_drive: what the bus leaves beside speed and resistance limits the force, and is told") {
    auto p = stage();
    p.bus = 60_V;
    three_phase_drive<> drive(p, T);
    CHECK(mean_after(drive, 7, 0, 50, 50) == doctest::Approx(280).epsilon(1e-6)); // 14 V of 34.6
    CHECK_FALSE(drive.limited());
    CHECK(mean_after(drive, 7, 1.0, 50, 50) < 0.9 * 280); // 26.7 V are the speed's
    CHECK(drive.limited());
    CHECK(mean_after(drive, 12, 0, 50, 50) == doctest::Approx(320).epsilon(1e-6)); // 8 A
    CHECK(drive.limited());
}
TEST_CASE(
    "three_phase_drive: at speed the controllers hold R I + kf/1.5 v across and -w L I along, switching or "
    "not") {
    auto p = stage();
    p.steps = 60; // 33 us: in the mean the magnets are half of that ahead, where some of v_q counts as v_d
    for (const bool switching : {false, true}) {
        CAPTURE(switching);
        p.switching = switching;
        three_phase_drive<> drive(p, T);
        CHECK(mean_after(drive, 3, 0.5, 50, 300) == doctest::Approx(120).epsilon(0.005));
        const double w = 2 * std::numbers::pi * 0.5 / 30e-3, across = 2 * 3 + 40 / 1.5 * 0.5,
                     late = across * w * 2e-3 / 60 / 2;
        CHECK(std::abs(drive.now().held_q - across) < 0.01);
        CHECK(std::abs(drive.now().held_d + w * 8e-3 * 3 + late) < 0.005);
    }
}
TEST_CASE("three_phase_drive: with switching the current is that of the average model between the pulses") {
    auto p = stage();
    three_phase_drive<> average(p, T);
    p.switching = true;
    three_phase_drive<> legs(p, T);
    double a = 0, b = 0;
    for (int k = 0; k < 200; ++k) a = average(3_A).value(), b = legs(3_A).value();
    CHECK(a == doctest::Approx(120).epsilon(1e-9));
    CHECK(b == doctest::Approx(120).epsilon(0.005));
    CHECK(std::abs(b - a) > 1e-6); // the pulses are there
    CHECK(std::abs(legs.now().beta - average.now().beta) < 1e-3);
}
TEST_CASE("three_phase_drive: refuses what no drive has, by name") {
    const auto message = [](auto change) -> std::string {
        auto p = stage();
        change(p);
        try {
            three_phase_drive<>(p, T);
        } catch (const invalid_parameter& e) {
            return e.what();
        }
        return {};
    };
    CHECK(message([](auto& p) { p.resistance = {}; }) ==
          "three_phase_drive.resistance = 0 V/A: must be finite and above 0");
    CHECK(message([](auto& p) { p.bus = {}; }).find("three_phase_drive.bus = 0 V") == 0);
    CHECK(message([](auto& p) { p.bandwidth = 900_Hz; }) ==
          "three_phase_drive.bandwidth = 900 Hz: must be above 0 and at most 1/12 of the current loop's rate "
          "(833.3333333333334 Hz)");
    CHECK(message([](auto& p) { p.gain_error = -1; }).find("three_phase_drive.gain_error = -1") == 0);
    CHECK(message([](auto& p) { p.steps = 0; }).find("three_phase_drive.steps = 0") == 0);
}
