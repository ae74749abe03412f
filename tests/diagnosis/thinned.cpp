// SPDX-License-Identifier: BSL-1.0
// A record with more rows than its time scale needs, of a measured command.
#include "claims.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/log/thinned.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

using namespace quadrant::diagnosis;
using workshop::said;
using workshop::value_of;

namespace {

constexpr double period = 2e-4, inertia = 0.05, coulomb = 1.2;

/// A joint of a robot at 5 kHz: swings of 0.5 rad by a PD controller, position with noise, torque measured.
machine_log swings() {
    std::mt19937_64 random(11);
    std::normal_distribution<double> of_position(0, 5e-6), of_torque(0, 0.01);
    std::string out = "t_s,q_pos_rad,q_cmd_Nm\n";
    double q = 0, v = 0;
    constexpr int fine = 10;
    for (int k = 0; k < 30000; ++k) {
        const double t = k * period, w = 2 * std::numbers::pi * 0.8;
        const double asked = 0.5 * (1 - std::cos(w * t)), speed = 0.5 * w * std::sin(w * t);
        const double torque = 400 * (asked - q) + 8 * (speed - v);
        char row[80];
        std::snprintf(row, sizeof row, "%.6f,%.9f,%.6f\n", t, q + of_position(random),
                      torque + of_torque(random));
        out += row;
        for (int i = 0; i < fine; ++i) {
            const double h = period / fine;
            v += h * (torque - coulomb * std::tanh(v / 1e-3) - 0.3 * v) / inertia;
            q += h * v;
        }
    }
    std::istringstream file(out);
    return read_log(file, "joint.csv");
}
machine_description described(const std::string& more = "") {
    return read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 2e-4, "axes": {"q": {
        "plant": {"inertia_kg_m2": 0.05, "viscous_Nm_s_per_rad": 0.3}, "tolerance": {"inertia": 0.2, "viscous": 0.2},
        "actuator": {"command_is": ")" +
                         std::string(more.empty() ? "measured" : more) + R"("}}}})"),
        "joint.json");
}
bool is_thinned(const diagnosis_result& r) {
    return std::any_of(r.notes.begin(), r.notes.end(),
                       [](const std::string& n) { return n.find("are taken as one") != n.npos; });
}

} // namespace

TEST_CASE("thinned: a reading stays a reading, a command keeps its impulse, a mark stays a mark") {
    axis_log log;
    for (int k = 0; k < 11; ++k) {
        log.position.push_back(k * k);
        log.command.push_back(k);
        log.left_out.push_back(k == 4);
    }
    const axis_log out = thinned(log, 3); // the last two rows make no whole one
    CHECK(out.position == std::vector<double>{0, 9, 36});
    CHECK(out.command == std::vector<double>{1, 4, 7});
    CHECK(out.left_out == std::vector<unsigned char>{0, 1, 0});
    CHECK(out.velocity.empty());
    CHECK(!out.as_sampled);
    CHECK(thinned(log, 1).position == log.position);
    CHECK(thinned(log, 1).as_sampled);
}

TEST_CASE("thinned: as many rows become one as leave seventeen in a cycle of the corner") {
    CHECK(rows_in_one(60, 1e-3) == 1); // 16.7 rows
    CHECK(rows_in_one(60, 5e-4) == 2);
    CHECK(rows_in_one(60, 2e-4) == 5);
    CHECK(rows_in_one(65, 2e-4) == 4);
    CHECK(rows_in_one(300, 1e-3) == 1);
}

TEST_CASE("thinned: a joint at 5 kHz with its torque measured is diagnosed on fewer rows, and its friction is "
          "found" *
          doctest::test_suite("all")) {
    const machine_log log = swings();
    const diagnosis_result r = diagnose(described(), log, nullptr, [](const std::string&) {}, {});
    CHECK(is_thinned(r));
    REQUIRE(!r.causes.empty());
    CHECK(r.causes.front().effect == "coulomb_friction");
    CHECK(r.causes.front().group_probability > 0.9);
    CHECK(r.causes.front().parameters.front().values.front().value == doctest::Approx(coulomb).epsilon(0.05));
    // A command that was asked for is replayed, and what a drive loses of it lies within its rows.
    CHECK(!is_thinned(diagnose(described("asked"), log, nullptr, [](const std::string&) {}, {})));
}
