// SPDX-License-Identifier: BSL-1.0
// A robot's joint whose torque and angle were logged ten times a second: a row is a third of the time in which
// its friction would stop it. A model that is damped much more follows every torque at once, and little of what
// it lacks shows in its predictions.
#include "claims.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/fit/late_command.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>
#include <string>

using namespace quadrant::diagnosis;
using workshop::said;

namespace {

constexpr double inertia = 8.2, viscous = 31.5, coulomb = 21.2;

/// Place on a way of trapezoidal moves from end to end, a shorter one after each.
double asked_at(double t) {
    constexpr double speed = 1, acceleration = 1.5, pause = 0.3;
    for (int move = 0;; ++move) {
        const double length = 2.4 - 0.15 * (move / 2 % 14), ramp = speed / acceleration,
                     cruise = length / speed - ramp;
        const double lasts = cruise + 2 * ramp, from = move % 2 ? length : 0, sign = move % 2 ? -1 : 1;
        if (t < lasts) {
            const double up = std::min(t, ramp), even = std::clamp(t - ramp, 0.0, cruise),
                         down = std::max(0.0, t - ramp - cruise);
            return from + sign * (acceleration * up * up / 2 + speed * even + speed * down -
                                  acceleration * down * down / 2);
        }
        t -= lasts + pause;
        if (t < 0) return move % 2 ? 0 : length;
    }
}

constexpr int tenth = 100, seventh = 150; ///< of a second, in steps of the loop

/// A stiff loop in steps of a millisecond, of which one in `every` is logged.
std::string record(int every) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0, 0.5);
    std::string out = "t_s,q_pos_rad,q_torque_Nm\n";
    double q = 0, v = 0;
    constexpr double h = 1e-3;
    for (int k = 0; k < 60000; ++k) {
        const double t = k * h;
        const double torque = inertia * (3600 * (asked_at(t) - q) - 100 * v);
        if (k % every == 0) {
            char row[80];
            std::snprintf(row, sizeof row, "%.6f,%.9f,%.6f\n", t, q, torque + noise(random));
            out += row;
        }
        v += h / inertia * (torque - viscous * v - coulomb * std::tanh(v / 0.002));
        q += h * v;
    }
    return out;
}

/// `axis`: plant and tolerances.
diagnosis_result diagnosed(const std::string& axis, int every = tenth) {
    const auto machine = read_machine(
        fmt::format(R"({{"schema": "quadrant.machine/1", "sample_period_s": {}, "axes": {{"q": {{{},
                    "encoder": {{"resolution_rad": 1e-5}}, "actuator": {{"command_is": "measured"}}}}}}}})",
                    every / 1000.0, axis),
        "joint.json");
    std::istringstream file(record(every));
    return diagnose(machine, read_log(file, "joint.csv"));
}
const std::string without_friction = R"("plant": {"inertia_kg_m2": 8.2})",
                  as_it_is =
                      R"("plant": {"inertia_kg_m2": 8.2, "viscous_Nm_s_per_rad": 31.5, "coulomb_Nm": 21.2},
                         "tolerance": {"inertia": 0.02, "viscous": 0.02, "coulomb": 0.02})";

} // namespace

TEST_CASE("diagnose: no friction beyond what the torque shows, where rows are slow") {
    const auto d = diagnosed(without_friction);
    CAPTURE(said(d));
    REQUIRE(!d.causes.empty());
    const cause& first = d.causes.front();
    CHECK((first.effect == "viscous_friction" || first.effect == "coulomb_friction"));
    for (const cause& c : d.causes) {
        if (c.effect != "viscous_friction" || c.group_probability < 0.5) continue;
        const estimate& found = c.parameters.at(0).values.at(0);
        CHECK(found.low < viscous);
        CHECK(found.high > viscous);
    }
}

TEST_CASE("diagnose: where rows are slow, Coulomb friction is told beside viscous friction") {
    const auto d = diagnosed(without_friction);
    CAPTURE(said(d));
    bool dry = false;
    for (const cause& c : d.causes) {
        if (c.effect != "coulomb_friction" || !(c.group_probability > 0.3)) continue;
        dry = true;
        const estimate& found = c.parameters.at(0).values.at(0);
        CHECK(found.low < coulomb);
        CHECK(found.high > coulomb);
    }
    CHECK(dry);
}

TEST_CASE("diagnose: where rows are slow, a joint as described is blamed for nothing") {
    for (const int every : {tenth, seventh}) {
        CAPTURE(every);
        const auto d = diagnosed(as_it_is, every);
        CAPTURE(said(d));
        for (const cause& c : d.causes) CHECK(c.group_probability < 0.5);
    }
}

TEST_CASE("diagnose: a mass that acts as a torque half a row late does is no claim") {
    const auto d = diagnosed(without_friction, seventh);
    CAPTURE(said(d));
    REQUIRE(!d.causes.empty());
    CHECK(d.causes.front().effect == "viscous_friction");
    for (const cause& c : d.causes)
        if (c.effect == "mass") CHECK(c.group_probability < 0.5);
}

TEST_CASE("late command: a measured one that may go to its next row in a line does, where half a row is told") {
    std::istringstream file(record(seventh));
    const auto log = read_log(file, "joint.csv").axes.front();
    plant_description joint;
    joint.mass_kg = inertia;
    joint.force_constant_N_per_V = 1;
    const double rows = seventh / 1000.0;
    const command_timing t = timing_of_command(log, rows, joint);
    REQUIRE(!t.sure());
    REQUIRE(t.of_plant);
    CHECK(lateness_of_command(log, rows, joint, command_origin::measured) == rows / 2);
    CHECK(lateness_of_command(log, rows, joint, command_origin::asked) == 0);
}
