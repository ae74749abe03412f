// SPDX-License-Identifier: BSL-1.0
// A robot's joint, torque measured, pushed by forces that no name explains: they are as large as the friction
// that the machine file lacks. The friction is found all the same, with its value.
#include "claims.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <array>
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

constexpr double period = 0.002, inertia = 1.1, viscous = 8, coulomb = 7.2, push = 6;

/// Sinusoids by a stiff loop on the position, in fine steps.
struct pushed_by {
    std::array<double, 3> frequency, phase, along;

    double at(double t, double q) const {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            sum += std::sin(2 * std::numbers::pi * frequency[i] * t + phase[i]) *
                   std::cos(along[i] * q + phase[i]);
        return push * sum / 1.2;
    }
    std::string record() const {
        std::mt19937_64 random(5);
        std::normal_distribution<double> noise(0, 0.3);
        std::string out = "t_s,q_pos_rad,q_torque_Nm\n";
        double q = 0, v = 0, before = 0;
        constexpr int fine = 20;
        constexpr double count = 1e-5;
        for (int k = 0; k < 4500; ++k) {
            const double t = k * period, turn = 2 * std::numbers::pi * t;
            const double asked =
                std::min(t, 1.0) * (0.9 * std::sin(0.35 * turn) + 0.5 * std::sin(0.8 * turn + 1) +
                                    0.25 * std::sin(1.7 * turn + 2));
            const double read = std::round(q / count) * count;
            const double torque = inertia * (3600 * (asked - read) - 100 * (read - before) / period);
            before = read;
            for (int i = 0; i < fine; ++i) {
                const double h = period / fine;
                v += h / inertia * (torque - viscous * v - coulomb * std::tanh(v / 0.002) - at(t + i * h, q));
                q += h * v;
            }
            char row[80];
            std::snprintf(row, sizeof row, "%.6f,%.9f,%.6f\n", t, read, torque + noise(random));
            out += row;
        }
        return out;
    }
};

machine_description joint_of_a_robot() {
    return read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.002, "axes": {"q": {
        "plant": {"inertia_kg_m2": 1.1, "viscous_Nm_s_per_rad": 8}, "tolerance": {"inertia": 0.2, "viscous": 0.15},
        "encoder": {"resolution_rad": 1e-5}, "actuator": {"command_is": "measured"}}}})"),
        "joint.json");
}

} // namespace

TEST_CASE("diagnose: friction beside forces that no name explains, by a measured torque" *
          doctest::test_suite("all")) {
    const std::array pushes{pushed_by{{0.475, 1.402, 1.293}, {1.6, 3.11, 2.82}, {2.3, 2.58, 1.19}},
                            pushed_by{{0.607, 0.434, 0.815}, {0.97, 0.42, 2.52}, {2.84, 2.6, 2.53}}};
    for (const pushed_by& forces : pushes) {
        std::istringstream file(forces.record());
        const auto d = diagnose(joint_of_a_robot(), read_log(file, "joint.csv"));
        CAPTURE(said(d));
        CHECK(d.verdict == verdict::partly_explained);
        REQUIRE(!d.causes.empty());
        CHECK(d.causes.front().effect == "coulomb_friction");
        CHECK(d.causes.front().group_probability > 0.5);
        CHECK(value_of(d.causes.front(), "coulomb_Nm").value == doctest::Approx(coulomb).epsilon(0.1));
        for (std::size_t i = 1; i < d.causes.size(); ++i) CHECK(d.causes[i].group_probability < 0.5);
    }
}
