// SPDX-License-Identifier: BSL-1.0
// A light motor that creeps against a large cogging torque: models that stand still predict its readings well,
// and contradict its motion.
#include "claims.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/fit/for_machine.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/which/axis_case.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>
#include <string>

using namespace quadrant::diagnosis;
using workshop::said;
using workshop::value_of;

namespace {

constexpr double period = 0.002, inertia = 2.5e-4, cogging = 0.8, coulomb = 0.15,
                 count = 2 * 3.14159265358979 / 8192;

/// A swing, then a creep of 0.75 rad/s by a PID, in fine steps; torque measured.
std::string creeping() {
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0, 0.004);
    std::string out = "t_s,q_pos_rad,q_cmd_Nm\n";
    double q = 0, v = 0, torque = 0, integral = 0, read = 0, before = 0;
    constexpr int fine = 200;
    for (int k = 0; k < 4000; ++k) {
        const double t = k * period;
        read = std::round(q / count) * count;
        // 1.5 rad and back, then 0.75 rad/s
        const double swing = 2 * 3.14159265358979 * std::min(t, 0.4) / 0.4;
        const double asked = 0.75 * (1 - std::cos(swing)) + 0.75 * std::max(0.0, t - 0.4);
        const double error = asked - read;
        integral += 30 * error * period;
        const double command = 5 * error + 0.05 * (error - before) / period + integral;
        before = error;
        double mean = 0;
        for (int i = 0; i < fine; ++i) {
            const double h = period / fine;
            torque += (command - torque) * h / 0.001;
            mean += torque / fine;
            const double sign = std::tanh(v / 0.005);
            const double net = torque - coulomb * sign - 0.002 * v - cogging * std::sin(7 * q + 0.6) -
                               0.15 * std::sin(14 * q + 1.1);
            v += h * net / inertia;
            q += h * v;
        }
        char row[80];
        std::snprintf(row, sizeof row, "%.6f,%.9f,%.6f\n", t, read, mean + noise(random));
        out += row;
    }
    return out;
}

machine_description motor() {
    return read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.002, "axes": {"q": {
        "plant": {"inertia_kg_m2": 2.5e-4}, "tolerance": {"inertia": 0.3},
        "encoder": {"resolution_rad": 7.67e-4}, "actuator": {"command_is": "measured"}}}})"),
        "motor.json");
}
machine_log record() {
    std::istringstream file(creeping());
    return read_log(file, "creep.csv");
}

} // namespace

namespace {

/// The record, ready for fits, and the machine file's plant. Not to be copied: the record refers to the log.
struct prepared {
    machine_description machine = motor();
    machine_log log = record();
    std::size_t motions = 0;
    axis_record r = ready();
    plant_model given{machine.axes.front(), r.scale.give()};

    prepared() = default;
    prepared(const prepared&) = delete;
    axis_record ready() {
        const auto& axis = machine.axes.front();
        const auto& l = log.axes.front();
        return for_machine(
            in_pieces(prepare(l, period, count, scales_of(axis.plant, l, period, count)), motions), axis);
    }
    /// As the record was made.
    plant_model right() const {
        plant_model out = given;
        out.friction.coulomb = coulomb;
        out.friction.viscous_slope = 0.002;
        out.cogging = harmonics(2 * 3.14159265358979 / 7, std::vector{-cogging, -0.15}, std::vector{0.6, 1.1});
        return out;
    }
};
double mean_of_counted(const std::vector<double>& x, const led_motion& by) {
    double sum = 0, rows = 0;
    for (std::size_t k = 500; k < x.size(); ++k) // behind the swing
        if (by.counts[k]) {
            sum += x[k];
            ++rows;
        }
    return sum / rows;
}

} // namespace

TEST_CASE("along the motion: a force too much is found with its size and its sign") {
    const prepared made;
    const auto by = motion_to_lead(made.r, made.given);
    axis_record r = made.r;
    r.observer.led = by;
    constexpr double too_much = 0.1;
    plant_model pushed = made.right();
    pushed.constant_force += too_much;
    std::vector<double> e, e_right, a, a_right;
    r.observer.run(pushed, e, &a);
    r.observer.run(made.right(), e_right, &a_right);
    const double force = mean_of_counted(residual_of(r, pushed, a), *by) -
                         mean_of_counted(residual_of(r, made.right(), a_right), *by);
    CHECK(force ==
          doctest::Approx(too_much).epsilon(0.05)); // what the model pushes and the machine did not follow
    // At rest of x' = x + T v + (1 - z^2) e and v' = (1 - b T/M) v + T d/M + (1 - z)^2 e/T, see predictor.
    const double far = 1 - r.observer.pole(), damped = 0.002 * period / inertia;
    const double ahead = mean_of_counted(e, *by) - mean_of_counted(e_right, *by);
    CHECK(ahead ==
          doctest::Approx(-too_much * period * period / inertia / (far * far + damped * far * (2 - far)))
              .epsilon(0.05));
}

TEST_CASE(
    "along the motion: a friction that would hold the axis shows whole, which hardly shows in the readings") {
    const prepared made;
    const axis_record& r = made.r;
    const plant_model &given = made.given, right = made.right();
    const auto led = motion_to_lead(r, given);
    const auto left = [&](const plant_model& p) {
        std::vector<double> force;
        r.observer.forces_beside(*led, {&p, 1}, r.command, {&force, 1});
        return rms(force);
    };
    const auto corrected = [&](const plant_model& p) {
        std::vector<double> e;
        r.observer.run(p, e);
        return rms(std::span(e).subspan(500));
    };
    plant_model stands = given;
    stands.friction.coulomb = 2;
    CHECK(corrected(stands) < 0.2 * corrected(given)); // it predicts, because it does not move
    CHECK(left(stands) > 2 * left(given));             // and needs two newton metres to be moved
    CHECK(left(right) < 0.2 * left(given));
    plant_model weak = given;
    weak.force_constant *= 0.01; // explains nothing by making all forces small
    CHECK(left(weak) > 0.9 * left(given));
}

TEST_CASE("diagnose: a light motor that creeps over its cogging torque" * doctest::test_suite("all")) {
    const auto d = diagnose(motor(), record());
    CAPTURE(said(d));
    bool named = false;
    for (const cause& c : d.causes) {
        if (c.effect != "cogging" || c.probability < 0.5) continue;
        named = true;
        CHECK(std::abs(value_of(c, "cogging_period_rad").value - 2 * 3.14159265358979 / 7) < 0.01);
    }
    CHECK(named);
    for (const cause& c : d.causes)
        CHECK((c.probability < 0.5 || c.effect == "cogging" || c.effect == "coulomb_friction" ||
               c.effect == "viscous_friction" || c.effect == "constant_force"));
}

namespace {

/// A motor of 0.12 g m^2 with Coulomb friction of 0.03 N m that speeds up once; its torque by a sensor whose
/// white noise is of this size [N m].
machine_log behind_noisy_sensor(double white) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0, white);
    constexpr double step = 0.001, read = 6e-4;
    std::vector<double> position, measured;
    double q = 0, v = 0;
    for (int k = 0; k < 12000; ++k) {
        const double torque = k < 4000 ? 0.05 : 0.06;
        position.push_back(std::round(q / read) * read);
        measured.push_back(torque + noise(random));
        for (int i = 0; i < 10; ++i) {
            const double h = step / 10, a = (torque - 0.03 * std::tanh(v / 0.5) - 7e-5 * v) / 1.2e-4;
            q += h * (v + h / 2 * a);
            v += h * a;
        }
    }
    return workshop::torque_log(position, measured, step, 1e-6);
}

} // namespace

TEST_CASE("diagnose: the noise of a torque sensor is no weak motor, and no friction that grows with the load" *
          doctest::test_suite("all")) {
    auto machine = read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"q": {
        "plant": {"inertia_kg_m2": 1.2e-4, "viscous_Nm_s_per_rad": 7e-5},
        "tolerance": {"inertia": 0.1, "viscous": 0.2},
        "encoder": {"resolution_rad": 6e-4}, "actuator": {"command_is": "measured"}}}})"),
        "motor.json");
    for (const double white : {0.06, 0.02}) {
        if (white < 0.03) machine.excluded_effects = {"force_constant"}; // load friction is the nearest then
        const auto d = diagnose(machine, behind_noisy_sensor(white));
        CAPTURE(said(d));
        REQUIRE(!d.causes.empty());
        CHECK(d.causes.front().effect == "coulomb_friction");
        CHECK(d.causes.front().group_probability > 0.9);
        for (const cause& c : d.causes)
            if (c.effect == "force_constant" || c.effect == "load_friction") CHECK(c.group_probability < 0.5);
    }
}
