// SPDX-License-Identifier: BSL-1.0
// Situation: an axis reverses under dry friction and is late for a while: the quadrant glitch of a circle.
// From: 0.17 mm of quadrant error, a friction compensation that did not act (SINUMERIK, field.md 6.17).
//
// The machine's friction is stribeck; the controller believes in one Coulomb level that is none of the
// machine's.
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
constexpr double T = 500e-6;
const auto Ts = 500_us;
using boxes =
    cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, notch<signal::voltage>>;
using machine = linear_motor<stribeck<>>;

/// The thesis' x axis ([Jamaludin2008] ch. 2 and 3), notch in the command as in docs/formats.md.
machine::parameters x_axis() {
    return {.mass = 340_kg,
            .force_constant = 1450_N / 1_V,
            .friction = {.coulomb = 122_N,
                         .static_level = 177_N,
                         .stribeck_velocity = 1_mps / 450.0,
                         .viscous = 950_N / 1_mps},
            .delay = 0.4_ms,
            .limit = 10_V,
            .dac_step = {},
            .encoder_step = 250_nm};
}
/// Identified badly enough: mass 3 % and viscous friction 10 % off.
boxes::parameters tuning(double coulomb_newtons) {
    return {.position_gain = 150.0 / 1_s,
            .velocity_gain = 60_V / 1_mps,
            .velocity_integral = 450_V / 1_m,
            .estimator = {.corner = 150_Hz},
            .velocity_feedforward = 1,
            .acceleration_feedforward = 330_kg / (1450_N / 1_V),
            .viscous_feedforward = 860_N / 1_mps / (1450_N / 1_V),
            .coulomb_feedforward = coulomb_newtons * 1_N / (1450_N / 1_V),
            .notch = {.centre = 330_Hz, .width = 0.0606},
            .limit = 10_V,
            .dac_step = 20_V / 65536.0};
}

struct glitch {
    double near = 0;      ///< largest error within 100 ms after a reversal [um]
    double elsewhere = 0; ///< and in the rest of the stroke
    double after = 0;     ///< of the reversal it came [ms]
    bool limited = false, faulted = false;
};
/// Three periods of a sinusoid of 30 mm; the first is not looked at.
glitch sinusoid(double coulomb_newtons, double peak_mm_per_s, machine::parameters table = x_axis()) {
    cascade<boxes> axis{.box = {tuning(coulomb_newtons), Ts}};
    machine motor{table, Ts};
    const double w = peak_mm_per_s / 30, half = std::numbers::pi / w;
    quantity<si::length> reading{};
    glitch found;
    for (int k = 0; k * T < 6 * half; ++k) {
        reading = motor(axis(0.03 * (1 - std::cos(w * k * T)) * 1_m, reading));
        found.limited = found.limited || axis.limited();
        found.faulted = found.faulted || axis.faulted() || motor.faulted();
        if (k * T < 2 * half) continue;
        const double error = 1e6 * std::abs(axis.wire.position_error.value()), late = std::fmod(k * T, half);
        if (late >= 0.1) found.elsewhere = std::max(found.elsewhere, error);
        if (late < 0.1 && error > found.near) found.near = error, found.after = 1e3 * late;
    }
    return found;
}
} // namespace

TEST_CASE(
    "reversal: without compensation the axis is 10 to 30 um late within 50 ms after a reversal at 100 mm/s") {
    const glitch g =
        sinusoid(0, 100); // thesis, table 4.2: 15 um published, 21.8 um with its friction model here
    CHECK(g.near > 10);
    CHECK(g.near < 30);
    CHECK(g.after < 50);
    CHECK(g.near > 2 * g.elsewhere); // where mass and viscous friction are off
    CHECK_FALSE(g.limited);
    CHECK_FALSE(g.faulted);
}
TEST_CASE(
    "reversal: a Coulomb feedforward of 140 N takes at least two thirds of it, and leaves less than 7 um") {
    const glitch without = sinusoid(0, 100), with = sinusoid(140, 100); // published: 15 to 5 um
    CHECK(with.near < without.near / 3);
    CHECK(with.near < 7);
    CHECK(with.near > 1); // what one level leaves of another law: had the plant the controller's friction, none
    CHECK(with.elsewhere < without.elsewhere + 1);
}
TEST_CASE(
    "reversal: at 10 mm/s, where the machine's level is higher, the same feedforward takes two thirds, too") {
    const glitch without = sinusoid(0, 10), with = sinusoid(140, 10);
    CHECK(without.near > 10);
    CHECK(with.near < without.near / 3);
}
TEST_CASE("reversal: from 0 to 120 N the glitch falls with every step of the feedforward") {
    double before = sinusoid(0, 100).near;
    for (const double newtons : {30.0, 60.0, 90.0, 120.0}) {
        const double now = sinusoid(newtons, 100).near;
        CHECK(now < before);
        before = now;
    }
}
TEST_CASE("reversal: a feedforward twice too large is worse than none; one of the wrong sign is refused") {
    CHECK(sinusoid(300, 100).near > sinusoid(0, 100).near);
    CHECK_THROWS_WITH_AS(sinusoid(-145, 100),
                         "coulomb_viscous.coulomb = -0.1 V: must be finite and not below 0", invalid_parameter);
}
TEST_CASE("reversal: it is the friction: without it nothing stands out after a reversal") {
    auto smooth = x_axis();
    smooth.friction.coulomb = 0_N, smooth.friction.static_level = 0_N;
    const glitch g = sinusoid(0, 100, smooth);
    CHECK(g.near < g.elsewhere + 1); // um
}
