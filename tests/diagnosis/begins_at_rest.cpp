// SPDX-License-Identifier: BSL-1.0
// Records that begin with their only motion: the axis stands still at the first reading, a step is asked for,
// and then it rests. And a command that is a law of the position, which says nothing of a weight.
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/fit/record.hpp>
#include <quadrant/diagnosis/fit/regression.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 1e-3, inertia = 0.02, viscous = 0.6;

/// An arm under P control of its position, stepped fifty times a row: it is asked to be at 1 rad from the tenth
/// row on, or to swing.
enum class asks { step, swing };
std::string response(asks what, double gain, double weight) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 2e-5);
    std::string out = "t_s,q_pos_rad,q_cmd_Nm\n";
    double q = 0, v = 0;
    for (int k = 0; k < (what == asks::step ? 4000 : 16000); ++k) {
        const double t = k * period;
        const double asked =
            what == asks::step ? (k < 10 ? 0 : 1) : 0.9 * std::sin(1.3 * t) + 0.4 * std::sin(4.1 * t);
        const double read = q + noise(random), torque = gain * (asked - read);
        char row[80];
        std::snprintf(row, sizeof row, "%.3f,%.7f,%.9f\n", t, read, torque);
        out += row;
        for (int i = 0; i < 50; ++i) {
            v += period / 50 * (torque - viscous * v - weight * std::sin(q)) / inertia;
            q += period / 50 * v;
        }
    }
    return out;
}
machine_description described(double as_described) {
    char text[400];
    std::snprintf(text, sizeof text,
                  R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"q": {
        "plant": {"inertia_kg_m2": %g, "viscous_Nm_s_per_rad": 0.6, "delay_s": 0},
        "tolerance": {"inertia": 0.05, "viscous": 0.1}, "encoder": {"resolution_rad": 1e-7}}}})",
                  as_described);
    return read_machine(std::string_view(text), "machine.json");
}
diagnosis_result diagnosed(double as_described) {
    rules one;
    one.threads = 1;
    return diagnose(
        described(as_described), read_log_text(response(asks::step, 8, 0), "log.csv"), nullptr,
        [](const std::string&) {}, one);
}

} // namespace

TEST_CASE("a record that begins with its motion: the motion is judged, where the axis stands still before it") {
    CHECK(diagnosed(inertia).verdict <= verdict::within_tolerance);
    CHECK(diagnosed(2.5 * inertia).verdict > verdict::within_tolerance);
}

TEST_CASE("a record that begins in motion has no known beginning, one that begins at rest has") {
    const auto rows_left_out = [](std::size_t from) {
        const machine_log in = read_log_text(response(asks::step, 8, 0), "log.csv");
        axis_log log = in.axes[0];
        log.position.erase(log.position.begin(), log.position.begin() + static_cast<std::ptrdiff_t>(from));
        log.command.erase(log.command.begin(), log.command.begin() + static_cast<std::ptrdiff_t>(from));
        log.reference = log.position;
        const auto machine = described(inertia);
        return prepare(log, period, 1e-7, scales_of(machine.axes[0].plant, log, period, 1e-7)).score.skip;
    };
    CHECK(rows_left_out(0) == 0);
    CHECK(rows_left_out(16) > 0); // the step has begun, most of its acceleration is to come
}

TEST_CASE("regress: the gain of a P controller is no weight, and a weight is one beside it") {
    const auto weight = [](const std::string& log) {
        const machine_log in = read_log_text(log, "log.csv");
        return regress(in.axes[0], period).weight;
    };
    CHECK(!weight(response(asks::step, 8, 0)).sure());
    const machine_log step = read_log_text(response(asks::step, 8, 0), "log.csv");
    CHECK(!regress(step.axes[0], period).acceleration.sure());
    const regressed found = weight(response(asks::swing, 8, 0.5));
    CHECK(found.sure());
    CHECK(found.value == doctest::Approx(0.5).epsilon(0.1));
}

TEST_CASE("observed_count: of an axis that is fast in nearly all rows it is the smallest difference, and some "
          "roundings are none") {
    std::vector<double> fast{0}, rounded{0};
    std::mt19937 random(5);
    for (int k = 0; k < 4000; ++k) {
        fast.push_back(fast.back() + 6.283185e-4 * (k % 400 == 0 ? 1 : 200 + static_cast<int>(random() % 23)));
        rounded.push_back(rounded.back() + 1e-6 * (k % 2000 == 0 ? 2 : 40 + static_cast<int>(random() % 51)));
    }
    CHECK(observed_count(fast, 1e-10) == doctest::Approx(6.283185e-4).epsilon(1e-3));
    CHECK(observed_count(rounded, 1e-6) == 1e-6);
    // Rows a little early and late of an axis that starts: any difference is near some last digits.
    std::vector<double> jittered;
    std::normal_distribution<double> late(0, 3e-5);
    for (int k = 0; k < 4000; ++k) {
        const double t = 1e-3 * k + late(random);
        jittered.push_back(1e-5 * std::round(0.2 * t * t / 1e-5));
    }
    CHECK(observed_count(jittered, 1e-5) == doctest::Approx(1e-5));
    std::vector<double> thirds = jittered; // and an encoder that counts in three of them
    for (double& x : thirds) x = 3e-5 * std::round(x / 3e-5);
    CHECK(observed_count(thirds, 1e-5) == doctest::Approx(3e-5));
}
