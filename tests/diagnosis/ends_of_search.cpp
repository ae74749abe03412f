// SPDX-License-Identifier: BSL-1.0
// Where the search for a number ends: far enough out for real machines; a number that ends there is no claim.
#include "claims.hpp"
#include "drive_simulator.hpp"

#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <sstream>

using namespace quadrant::diagnosis;
using workshop::said;

TEST_CASE("time delay: one of 24 rows is a delay with its value, no lag") {
    workshop::machine real;
    real.control.velocity_gain /= 8;
    real.control.position_gain *= 0.1;
    real.control.integral = 20;
    auto file = workshop::described(real);
    real.delay += 24 * workshop::period;
    const auto d = diagnose(file, workshop::as_log(workshop::run(real)));
    CAPTURE(said(d));
    REQUIRE(!d.causes.empty());
    CHECK(d.causes[0].effect == "time_delay");
    CHECK(workshop::near(workshop::value_of(d.causes[0], "delay_s").value, real.delay, 0.02));
}

TEST_CASE("Stribeck friction: a servo whose contact gives way by two counts has none" *
          doctest::test_suite("all")) {
    drive_simulator::machine servo{.mass = 0.01,
                                   .coulomb = 0.03,
                                   .viscous = 0.05,
                                   .duty_gain = 3,
                                   .supply = 7.2,
                                   .kt = 0.25,
                                   .delay = 0.02,
                                   .count = 0.00153398,
                                   .gravity = 0.5};
    servo.give = 0.003;
    auto file = read_machine(
        R"({"schema": "quadrant.machine/1", "sample_period_s": 0.01, "axes": {"q": {
            "plant": {"inertia_kg_m2": 0.0099, "torque_constant_Nm_per_V": 0.2502, "viscous_Nm_s_per_rad": 0.0515,
                      "coulomb_Nm": 0.0310, "presliding_angle_rad": 0.0031, "gravity_torque_Nm": 0.5},
            "tolerance": {"inertia": 0.03, "torque_constant": 0.02, "viscous": 0.1, "coulomb": 0.08, "gravity_torque": 0.03,
                          "command_delay": 0.1, "position_gain": 0.03, "supply": 0.02},
            "encoder": {"resolution_rad": 0.00153398},
            "drive": {"kind": "position_servo", "position_gain_per_rad": 3.03, "supply_V": 7.2, "maximum_duty": 1,
                      "command_delay_s": 0.0201}}}})",
        "machine.json");
    const auto log = [&](double pace, unsigned seed) {
        std::istringstream text(
            drive_simulator::log(drive_simulator::takes::servo, servo, 0.01, pace, seed, "rad", true));
        return read_log(text, "log.csv");
    };
    for (const double gravity : {0.3, 0.6}) {
        servo.gravity = gravity;
        file.axes[0].plant.gravity_torque_Nm = 1.01 * gravity;
        const machine_log holdout = log(0.8, 2);
        const auto d = diagnose(file, log(1, 1), &holdout);
        CAPTURE(said(d));
        CHECK(workshop::claims(d).empty());
    }
}
TEST_CASE("cogging: one bump along the travel, whose period ends at the end of its search, is no claim" *
          doctest::test_suite("all")) {
    workshop::machine real;
    const auto file = workshop::described(real);
    real.stranger = [](double x, double, double) { return 20 * std::exp(-x * x / (0.01 * 0.01)); };
    const auto d = workshop::diagnosed(file, real);
    CAPTURE(said(d));
    bool suspected = false;
    for (const cause& c : d.causes)
        if (c.effect == "cogging") suspected = c.parameters.front().on_bound;
    CHECK(suspected);
    CHECK(workshop::claims(d).empty());
}
