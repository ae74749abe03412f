// SPDX-License-Identifier: BSL-1.0
// What repeats in time may come with the motion of the axis itself.
#include <quadrant/diagnosis/which/of_the_motion.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace quadrant::diagnosis;

TEST_CASE("a cutting force at a frequency of the motion is one that may come with it") {
    axis_record r;
    r.period = 1e-3;
    for (int k = 0; k < 12000; ++k) {
        const double turn = 2 * std::numbers::pi * k * r.period;
        r.velocity.push_back(20 * std::cos(0.25 * turn) + 15 * std::cos(0.75 * turn + 1));
    }
    const auto at = [](double low, double high) {
        cause c;
        c.effect = "cutting_force";
        c.parameters.push_back({"process.fundamental_Hz", {{(low + high) / 2, low, high}}});
        return c;
    };
    CHECK(detail::repeats_with_the_motion(r, at(0.6, 0.9)));
    CHECK(detail::repeats_with_the_motion(r, at(0.4, 1.2)));
    CHECK(detail::repeats_with_the_motion(r, at(-0.1, 0.5)));
    CHECK_FALSE(detail::repeats_with_the_motion(r, at(3, 3.2)));
    CHECK_FALSE(detail::repeats_with_the_motion(r, cause{}));
}

TEST_CASE("a process that pushes harder than the drive ever does is what a loop does across a play") {
    axis_record r;
    const std::vector<double> command{0, 3, -4};
    r.command = command;
    plant_model found;
    found.force_constant = 6;
    cause c;
    c.effect = "cutting_force";
    found.cutting = {0.02, {20, 1}, {0, 0}};
    CHECK_FALSE(detail::outdoes_the_drive(r, found, c));
    found.cutting = {0.02, {1, 25}, {0, 0}};
    CHECK(detail::outdoes_the_drive(r, found, c));
    c.effect = "cogging";
    CHECK_FALSE(detail::outdoes_the_drive(r, found, c));
}

// A record of a robot's joint, 63 s at 0.1 Hz, with a friction that bends with the speed: a mode at the third
// harmonic, with a damping of 0.0025, took a part of that force.
TEST_CASE("a mode that rings for longer than the record lasts is a force at one frequency") {
    axis_record r;
    r.period = 0.01;
    const std::vector<double> position(6300);
    r.position = position;
    const auto mode = [](double Hz, double damping) {
        cause c;
        c.effect = "structural_resonance";
        c.parameters.push_back({"mode_mass_kg", {{1, 0.9, 1.1}}});
        c.parameters.push_back({"mode_frequency_Hz", {{Hz, 0.9 * Hz, 1.1 * Hz}}});
        c.parameters.push_back({"mode_damping", {{damping, 0, 2 * damping}}});
        return c;
    };
    CHECK(detail::rings_beyond(r, mode(0.3, 0.0025)));
    CHECK(detail::rings_beyond(r, mode(45, 0)));
    CHECK_FALSE(detail::rings_beyond(r, mode(0.3, 0.03))); // falls to 1/e in 18 s
    CHECK_FALSE(detail::rings_beyond(r, mode(45, 0.001)));
    CHECK_FALSE(detail::rings_beyond(r, cause{}));
}

// A bent rail of 0.3 m was called cogging of 0.16 m at 0.81.
TEST_CASE("a wave with less than two periods on the travel is any curve") {
    axis_record r;
    r.scale.travel = 0.3;
    plant_model found;
    found.cogging = {0.16, {5, 1}, {0, 0}};
    CHECK(detail::repeats_too_seldom(r, found, "cogging"));
    CHECK_FALSE(detail::repeats_too_seldom(r, found, "force_ripple"));
    CHECK_FALSE(detail::repeats_too_seldom(r, found, "mass"));
    found.cogging = {0.16, {1, 5}, {0, 0}}; // the second is the strongest, twice as short
    CHECK_FALSE(detail::repeats_too_seldom(r, found, "cogging"));
    found.ripple = {0.149, {1}, {0}};
    CHECK_FALSE(detail::repeats_too_seldom(r, found, "force_ripple"));
    found.friction.along = {0.2, {1}, {0}};
    CHECK(detail::repeats_too_seldom(r, found, "position_dependent_friction"));
}
