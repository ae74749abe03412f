// SPDX-License-Identifier: BSL-1.0
// A motor that its viscous friction brakes within two rows of its log: what is led along the measured motion is
// braked by the velocity of each row, not by that of the row before.
#include "claims.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/fit/for_machine.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/which/pieces.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstdio>
#include <random>
#include <sstream>
#include <string>

using namespace quadrant::diagnosis;
using workshop::said;
using workshop::value_of;

namespace {

constexpr double period = 0.02, inertia = 0.0142, viscous = 0.356, coulomb = 0.228, delay = 0.016;

/// Volts that change every 0.1 to 0.5 s and never let the motor stand, in fine steps.
machine_log record(unsigned seed, int rows) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> volts(1.2, 2.9);
    std::uniform_int_distribution<int> lasts(5, 25);
    std::string out = "t_s,q_pos_rad,q_cmd_V\n";
    double q = 0, v = (1.5 - coulomb) / viscous, command = 1.5, before = 1.5;
    for (int k = 0, next = 20; k < rows; ++k) {
        if (k == next) {
            command = volts(random);
            next += lasts(random);
        }
        char row[80];
        std::snprintf(row, sizeof row, "%.4f,%.9f,%.9f\n", k * period, q, command);
        out += row;
        constexpr int fine = 1000;
        for (int i = 0; i < fine; ++i) {
            const double torque = (i < fine * delay / period ? before : command) - coulomb - viscous * v;
            v += period / fine * torque / inertia;
            q += period / fine * v;
        }
        before = command;
    }
    std::istringstream file(out);
    return read_log(file, "volts.csv");
}
machine_description motor(double with_viscous, double with_inertia = inertia) {
    char text[600];
    std::snprintf(text, sizeof text,
                  R"({"schema": "quadrant.machine/1", "sample_period_s": 0.02, "axes": {"q": {
        "plant": {"inertia_kg_m2": %g, "viscous_Nm_s_per_rad": %g, "coulomb_Nm": %g, "delay_s": %g,
                  "torque_constant_Nm_per_V": 1},
        "tolerance": {"inertia": 0.1, "viscous": 0.05, "coulomb": 0.1, "delay": 0.15, "torque_constant": 0.02},
        "encoder": {"resolution_rad": 1e-6}, "actuator": {}}}})",
                  with_inertia, with_viscous, coulomb, delay);
    return read_machine(std::string_view(text), "motor.json");
}

} // namespace

TEST_CASE("along the motion: a motor that is braked within two rows needs the torque of its file") {
    const machine_description machine = motor(viscous);
    const machine_log log = record(1, 3000);
    const auto& axis = machine.axes.front();
    const auto& l = log.axes.front();
    std::size_t motions = 0;
    const axis_record r =
        for_machine(in_pieces(prepare(l, period, 1e-6, scales_of(axis.plant, l, period, 1e-6)), motions), axis);
    const plant_model given(axis, r.scale.give());
    plant_model frictionless = given, by_direction = given;
    frictionless.friction.viscous_slope = 0;
    by_direction.friction.viscous_slope /= 1.2; // the motor turns forwards only
    by_direction.friction.viscous_asymmetry = 0.2;
    const auto by = motion_to_lead(r, given);
    std::array<std::vector<double>, 3> left;
    r.observer.forces_beside(*by, std::array{given, by_direction, frictionless}, r.command, left);
    double mean = 0;
    for (const double f : left[2]) mean += f / static_cast<double>(left[2].size());
    for (double& f : left[2]) f -= mean;
    CHECK(rms(std::span(left[0]).subspan(50)) < 0.01 * rms(left[2]));
    CHECK(rms(std::span(left[1]).subspan(50)) < 0.01 * rms(left[2]));
}

TEST_CASE(
    "diagnose: a motor that is braked within two rows is blamed for nothing, and what it lacks is named") {
    const machine_log log = record(1, 3000), other = record(2, 1500);
    const auto healthy = diagnose(motor(viscous), log, &other);
    CAPTURE(said(healthy));
    for (const cause& c : healthy.causes) CHECK(c.probability < 0.5);
    const auto half = diagnose(motor(viscous, 2 * inertia), log, &other);
    CAPTURE(said(half));
    REQUIRE(!half.causes.empty());
    CHECK(half.causes.front().effect == "mass");
    CHECK(half.causes.front().probability > 0.5);
    CHECK(value_of(half.causes.front(), "inertia_kg_m2").value == doctest::Approx(inertia).epsilon(0.1));
}
