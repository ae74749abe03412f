// SPDX-License-Identifier: BSL-1.0
// A joint whose torques something outside answers, as the ground does those of an ankle: what little is left of
// the command moves it.
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>

using namespace quadrant::diagnosis;

TEST_CASE(
    "diagnose: a limit or a lag that passes nothing of the command is no claim where the ground answers it") {
    constexpr double period = 0.01, inertia = 0.05;
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 1);
    std::string log = "t_s,q_pos_rad,q_cmd_Nm\n";
    double q = 0, v = 0, gait = 0;
    for (int k = 0; k < 3000; ++k) {
        const double t = k * period;
        gait += period * (1 + 0.2 * std::sin(0.7 * t));
        const double asked =
            0.15 * std::sin(2 * std::numbers::pi * gait) + 0.05 * std::sin(2 * std::numbers::pi * 2.3 * gait);
        const double torque = 120 * (asked - q) - 2 * v;
        char row[80];
        std::snprintf(row, sizeof row, "%.2f,%.7f,%.6f\n", t, q, torque);
        log += row;
        for (int i = 0; i < 20; ++i) {
            const bool stands = std::sin(2 * std::numbers::pi * gait) > -0.3;
            const double ground = stands ? -0.93 * torque - 3 * v + 0.3 * noise(random) : 0;
            v += period / 20 * (torque + ground - 1.5 * v) / inertia;
            q += period / 20 * v;
        }
    }
    const auto machine = read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.01, "axes": {"q": {
        "plant": {"inertia_kg_m2": 0.05, "viscous_Nm_s_per_rad": 1.5, "delay_s": 0},
        "tolerance": {"inertia": 0.1, "viscous": 0.2}, "encoder": {"resolution_rad": 1e-7}}}})"),
        "machine.json");
    rules one;
    one.threads = 1;
    const auto d = diagnose(
        machine, read_log_text(log, "log.csv"), nullptr, [](const std::string&) {}, one);
    for (const cause& c : d.causes)
        if (c.effect == "actuator_saturation" || c.effect == "actuator_lag")
            CHECK_MESSAGE(c.group_probability < 0.5, c.effect);
}
