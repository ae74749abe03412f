// SPDX-License-Identifier: BSL-1.0
// Two links of one arm, which a machine file describes as two axes alone: that they move each other is told,
// with the numbers of the law; axes that do not touch are not called an arm.
#include "claims.hpp"

#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace quadrant::diagnosis;
using workshop::near;

namespace {

/// A double pendulum: the elbow counts from the shoulder. `coupling` is the outer mass times both lever arms.
struct arm {
    double inner = 0.11, outer = 0.035, coupling = 0.03, weight = 1.9, outer_weight = 1.3, friction = 0.2;
};

/// The torques that the motion needs, measured with 1 mN m of noise.
std::string log_of(const arm& m) {
    constexpr double period = 0.002, turn = 2 * std::numbers::pi;
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, 1e-3);
    const auto angle = [&](double t, bool elbow) {
        const double grown = std::min(t, 1.0);
        return grown * (elbow ? 1.1 * std::sin(turn * 0.71 * t) + 0.5 * std::sin(turn * 0.29 * t + 1)
                              : 0.9 * std::sin(turn * 0.43 * t) + 0.4 * std::sin(turn * 1.03 * t + 2));
    };
    std::string out = "t_s,q1_pos_rad,q1_torque_Nm,q2_pos_rad,q2_torque_Nm\n";
    for (int k = 0; k < 6000; ++k) {
        const double t = k * period, h = 1e-3;
        std::array<double, 2> q{}, v{}, a{};
        for (const std::size_t j : {std::size_t{0}, std::size_t{1}}) {
            const double before = angle(t - h, j == 1), here = angle(t, j == 1), next = angle(t + h, j == 1);
            q[j] = here;
            v[j] = (next - before) / (2 * h);
            a[j] = (next - 2 * here + before) / (h * h);
        }
        const double c = m.coupling * std::cos(q[1]), s = m.coupling * std::sin(q[1]);
        const auto rubs = [&](double speed) { return m.friction * (speed > 0 ? 1 : -1); };
        const double both = m.outer_weight * std::sin(q[0] + (m.coupling > 0 ? q[1] : 0));
        const double shared = m.coupling > 0 ? m.outer : 0;
        const double shoulder = (m.inner + 2 * c) * a[0] + (shared + c) * a[1] - s * v[1] * (2 * v[0] + v[1]) +
                                m.weight * std::sin(q[0]) + both + rubs(v[0]);
        const double elbow = m.outer * a[1] + (shared + c) * a[0] + s * v[0] * v[0] +
                             m.outer_weight * std::sin(q[1] + (m.coupling > 0 ? q[0] : 0)) + rubs(v[1]);
        char row[160];
        std::snprintf(row, sizeof row, "%.4f,%.7f,%.6f,%.7f,%.6f\n", t, q[0], shoulder + noise(random), q[1],
                      elbow + noise(random));
        out += row;
    }
    return out;
}

diagnosis_result diagnosed(const arm& m) {
    const auto machine =
        read_machine(std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.002, "axes": {
        "q1": {"plant": {"inertia_kg_m2": 0.12}, "tolerance": {"inertia": 0.5}, "actuator": {"command_is": "measured"}},
        "q2": {"plant": {"inertia_kg_m2": 0.03}, "tolerance": {"inertia": 0.5}, "actuator": {"command_is": "measured"}}}})"),
                     "arm.json");
    std::istringstream text(log_of(m));
    auto log = read_log(text, "arm.csv");
    keep_described(machine, log);
    check_match(machine, log);
    return diagnose(machine, log);
}
std::string told(const diagnosis_result& d, const std::string& axis) {
    for (const auto& n : d.notes)
        if (n.starts_with("axis " + axis + ": it moves as the")) return n;
    return {};
}

double number_behind(const std::string& note, const std::string& words) {
    const auto at = note.find(words);
    return at == note.npos ? 0 : std::stod(note.substr(at + words.size()));
}

} // namespace

TEST_CASE("linked arm: two links that move each other are told with the numbers of their law, and which is the "
          "inner one") {
    const auto d = diagnosed({});
    CHECK(d.verdict >= verdict::partly_explained);
    const std::string inner = told(d, "q1"), outer = told(d, "q2");
    CAPTURE(inner);
    CAPTURE(outer);
    CHECK(inner.find("the inner link of an arm with axis q2") != inner.npos);
    CHECK(outer.find("the outer link of an arm with axis q1") != outer.npos);
    // Products of motions pass one low-pass of 5 Hz, so the numbers are not exact.
    for (const std::string& note : {inner, outer}) {
        CHECK(near(number_behind(note, "move each other by "), 0.03, 0.1));
        CHECK(near(number_behind(note, "Coulomb friction "), 0.2, 0.1));
    }
    CHECK(near(number_behind(inner, "the weight is "), 1.9, 0.2));
    CHECK(near(number_behind(inner, "own angle and "), 1.3, 0.2));
    CHECK(near(number_behind(outer, "own angle and "), 1.3, 0.1));
}
TEST_CASE("linked arm: two pendulums that do not touch are none, whatever friction and weight they have" *
          doctest::test_suite("all")) {
    const auto d = diagnosed({.coupling = 0});
    CHECK(told(d, "q1").empty());
    CHECK(told(d, "q2").empty());
}
