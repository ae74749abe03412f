// SPDX-License-Identifier: BSL-1.0
// The other names of a cause: which of them heads a group, and which is none because it follows no command.
#include "claims.hpp"

#include <quadrant/diagnosis/effect/effects.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/which/as_applied.hpp>

#include <cmath>
#include <cstdio>
#include <random>

using namespace quadrant::diagnosis;
using workshop::said;

namespace {

/// What a joint has besides, and its noise.
struct joint_rest {
    double noise = 6;         ///< of the torque, rms [N m]
    double load_friction = 0; ///< share of what inertia and weight ask for
    double of_no_name = 0;    ///< two more forces that no law of the diagnosis has [N m]
};

/// The second joint of a robot: strokes of 2 rad, slow and fast, with the current that they need and noise.
std::string joint_log(const joint_rest& rest = {}) {
    constexpr double period = 0.01, inertia = 16, viscous = 16.5, coulomb = 14.2, weight = 105;
    constexpr std::size_t rows = 9600, window = 40;
    const auto triangle = [](double t) {
        constexpr std::array<double, 4> stroke{8, 12, 20, 6};
        const double phase = std::fmod(std::fmod(t, 24) / stroke[static_cast<std::size_t>(t / 24) % 4], 1);
        return -2.6 + 4 * (phase < 0.5 ? phase : 1 - phase);
    };
    std::vector<double> q(rows);
    for (std::size_t k = 0; k < rows; ++k) q[k] = triangle(static_cast<double>(k) * period);
    for (int pass = 0; pass < 2; ++pass) { // corners become accelerations
        std::vector<double> smooth(rows);
        for (std::size_t k = 0; k < rows; ++k) {
            const std::size_t from = k > window / 2 ? k - window / 2 : 0,
                              to = std::min(rows, k + window / 2 + 1);
            double sum = 0;
            for (std::size_t i = from; i < to; ++i) sum += q[i];
            smooth[k] = sum / static_cast<double>(to - from);
        }
        q = smooth;
    }
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0, rest.noise);
    std::string out = "t_s,q_pos_rad,q_current_A\n";
    for (std::size_t k = 1; k + 1 < rows; ++k) {
        const double v = (q[k + 1] - q[k - 1]) / (2 * period),
                     a = (q[k + 1] - 2 * q[k] + q[k - 1]) / (period * period);
        const double sign = v > 1e-6 ? 1 : v < -1e-6 ? -1 : 0;
        const double passed = inertia * a - weight * std::cos(q[k]);
        const double torque = passed + viscous * v + (coulomb + rest.load_friction * std::abs(passed)) * sign +
                              rest.of_no_name * (std::sin(2 * q[k] + 0.3) + std::sin(3 * v)) + noise(random);
        char row[80];
        std::snprintf(row, sizeof row, "%.2f,%.4f,%.4f\n", static_cast<double>(k) * period, q[k], torque / 10);
        out += row;
    }
    return out;
}

} // namespace

TEST_CASE("rivals: a group is headed by a name whose numbers were found, not by one at the end of its search") {
    const auto named = [](const effect& e, double x, double weight) {
        detail::rival r{.model = {}, .name = &e, .weight = weight, .same = true};
        r.model.fit.plant.friction.coulomb = r.model.fit.plant.friction.excess = 1;
        r.model.fit.parameters = {{.key = std::string(e.keys.begin()->name), .low = 0, .high = 1}};
        r.model.fit.x = Eigen::VectorXd::Constant(1, x);
        return r;
    };
    using suspect::coulomb_friction, suspect::stribeck_friction, suspect::viscous_friction;
    const auto head = [](std::vector<detail::rival> group) {
        return std::string(detail::heading(group).name->name);
    };
    CHECK(head({named(stribeck_friction, 1, 0.6), named(coulomb_friction, 0.5, 0.4)}) == "coulomb_friction");
    CHECK(head({named(coulomb_friction, 0.5, 0.4), named(stribeck_friction, 1, 0.6)}) == "coulomb_friction");
    // Where all were found, or none, the likelier one.
    CHECK(head({named(stribeck_friction, 0.5, 0.6), named(coulomb_friction, 0.5, 0.4)}) == "stribeck_friction");
    CHECK(head({named(coulomb_friction, 1, 0.4), named(stribeck_friction, 1, 0.6)}) == "stribeck_friction");
    // What the record distinguishes from the first one heads nothing.
    auto other = named(viscous_friction, 0.5, 0.9);
    other.same = false;
    CHECK(head({named(stribeck_friction, 1, 0.1), other}) == "stribeck_friction");
}
TEST_CASE("rivals: a heavy joint of a weak motor, which follows no command, stands for no friction" *
          doctest::test_suite("all")) {
    const auto machine = read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.01, "axes": {"q": {
        "plant": {"inertia_kg_m2": 16, "torque_constant_Nm_per_A": 10},
        "tolerance": {"inertia": 0.3, "torque_constant": 0.02}, "actuator": {"command_is": "measured"}}}})"),
        "joint.json");
    std::istringstream text(joint_log());
    const auto d = diagnose(machine, read_log(text, "joint.csv"));
    CAPTURE(said(d));
    const auto names = workshop::claims(d);
    for (const char* name : {"gravity", "coulomb_friction", "viscous_friction"})
        CHECK(std::find(names.begin(), names.end(), name) != names.end());
    for (const cause& c : d.causes)
        for (const auto& other : c.confusable_with) {
            CHECK(other != "mass");
            CHECK(other != "force_constant");
        }
}

TEST_CASE("rivals: a torque constant that is too large is named where another name was found beside it first") {
    // Weight and friction follow it, and a further name corrects what they make: on the way to that one the
    // torque constant was no longer tried.
    const auto machine = read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.01, "axes": {"q": {
        "plant": {"inertia_kg_m2": 16, "torque_constant_Nm_per_A": 13, "viscous_Nm_s_per_rad": 16.5,
                  "coulomb_Nm": 14.2, "gravity_torque_Nm": 105, "gravity_phase_rad": 1.571},
        "tolerance": {"inertia": 0.15, "torque_constant": 0.02, "viscous": 0.1, "coulomb": 0.1,
                      "gravity_torque": 0.05},
        "actuator": {"command_is": "measured"}}}})"),
        "joint.json");
    std::istringstream text(joint_log({.noise = 2, .load_friction = 0.03, .of_no_name = 6}));
    const auto d = diagnose(machine, read_log(text, "joint.csv"));
    CAPTURE(said(d));
    CHECK(workshop::claims(d) == std::vector<std::string>{"force_constant", "load_friction"});
}
