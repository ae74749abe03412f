// SPDX-License-Identifier: BSL-1.0
// The whole loop of an xy-table as one type. Two controllers drive a table along a circle of 30 mm radius at
// 100 mm/s.
//
//   reference.x --> milling_axis (boxes of `controller`) -- V --> motor, friction, encoder --> reading.x
//   reference.y --> milling_axis (boxes of `controller`) -- V --> motor, friction, encoder --> reading.y
//
// Source: x axis of [Jamaludin2008]. The controller knows the mass and the friction of the table nearly.
// You should see: below 3 um; with `milling_axis_boxes<>` as the controller, without friction and observer,
// 22 um. In 05_milling_table.cpp a cutter pushes the table, and a memory learns what it does.
#include <quadrant/quadrant.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace quadrant;
using namespace quadrant::literals;

using friction = stribeck<signal::velocity, signal::voltage>; // fed forward, in volts
using observer = disturbance_observer<signal::voltage>;
using controller = milling_axis_boxes<friction, observer>; // of one axis
using slide = table_axis_boxes<linear_motor<stribeck<>>>;  // one axis of the machine
using table = xy_table<slide, slide>;

int main() {
    const auto push = 4.1_mps2 / 1_V; // acceleration of a slide for one volt
    const controller::parameters tuning{
        .position_gain = 150_per_s,
        .velocity_gain = 60_V / 1_mps,
        .velocity_integral = 450_V / 1_m,
        .estimator_corner = 150_Hz,
        .notch = {.centre = 330_Hz, .width = 0.06},
        .plant_gain = push,
        .friction = {.coulomb = 0.07_V, .static_level = 0.1_V, .stribeck_velocity = 2.2_mmps},
        .disturbance = {60_Hz, axis_model<signal::voltage>{push, 0_per_s}},
        .limit = 10_V};
    const stribeck<>::parameters rubs{
        .coulomb = 122_N, .static_level = 177_N, .stribeck_velocity = 2.2_mmps, .viscous = 850_N / 1_mps};
    const slide::parameters machine{
        .motor = {.mass = 340_kg, .force_constant = 1450_N / 1_V, .friction = rubs, .delay = 0.4_ms},
        .encoder_step = 250_nm};

    xy_loop<controller, controller, table> loop( // X, Y, Table
        {.control = {tuning, tuning}, .table = {machine, machine}}, 500_us);

    const double R = 0.03, w = 0.1 / R, turn = 3770; // m, rad/s, servo periods
    double largest = 0;
    for (int k = 0; k < 2 * turn; ++k) {
        const double c = std::cos(w * k * 500e-6), s = std::sin(w * k * 500e-6);
        const auto reading = loop({.x = {R * (c - 1) * 1_m, -R * w * s * 1_mps, -R * w * w * c * 1_mps2},
                                   .y = {R * s * 1_m, R * w * c * 1_mps, -R * w * w * s * 1_mps2}});
        const double error = std::hypot(R + reading.x.plain().value(), reading.y.plain().value()) - R;
        if (k > turn) largest = std::max(largest, std::abs(error)); // the first turn begins with a jump
    }
    std::printf("largest radial error of the second turn: %.1f um\n", 1e6 * largest);
}
