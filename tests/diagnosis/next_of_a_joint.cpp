// SPDX-License-Identifier: BSL-1.0
// The next experiment of a robot joint, and of axes whose drive closes loops of its own: it keeps inside the
// limits that the machine has proven, with the gains that it has.
#include "workshop.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/next/next_experiment.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <nlohmann/json.hpp>

using namespace quadrant::diagnosis;

namespace {

constexpr double rough = 0.002;                     ///< sample period [s]
constexpr shown_motion shown{0, -1.2, 1.2, 1.5, 6}; ///< of the joint [rad]
constexpr record_scales of_joint{.travel = 2.4, .speed = 1.5, .command = 30, .count = 1e-5, .corner_Hz = 30};

/// A joint that carries 12 N m of weight round, under P and PI with these gains.
axis_description robot_joint(double stiffness) {
    auto file =
        nlohmann::json::parse(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.002, "axes": {"q": {
        "plant": {"inertia_kg_m2": 0.8, "torque_constant_Nm_per_V": 4, "viscous_Nm_s_per_rad": 1.5, "coulomb_Nm": 1.2,
                  "gravity_torque_Nm": 12, "gravity_phase_rad": 0.1, "delay_s": 0.001},
        "encoder": {"resolution_rad": 1e-5}, "actuator": {"limit_V": 10},
        "controller": {"kind": "cascade_p_pi", "velocity_feedforward": 1}}}})");
    auto& c = file["axes"]["q"]["controller"];
    c["position_gain_per_s"] = 8 * stiffness;
    c["velocity_gain_V_s_per_rad"] = 0.8 * 40 / 4;
    c["velocity_integral_V_per_rad"] = 0.8 * 40 / 4 * 6;
    c["velocity_filter_Hz"] = 60;
    return read_machine(file.dump(), "joint.json").axes[0];
}
std::string driven(const std::string& drive) {
    return R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"q": {
        "plant": {"mass_kg": 100, "viscous_N_s_per_m": 60, "coulomb_N": 30}, "encoder": {"resolution_m": 1e-6},
        "tolerance": {"mass": 0.02, "viscous": 0.1, "coulomb": 0.1, "velocity_gain": 0.01, "velocity": 0.01,
                      "position_gain": 0.01, "command_delay": 0.05},
        "drive": {"velocity_gain_N_s_per_m": 25132.741, "command_delay_s": 0.001, )" +
           drive + "}}}}";
}
/// A log that holds each of these motions.
proven_limits proven(const proving_ground& free, const plant_model& plant,
                     const std::vector<planned_motion>& motions) {
    axis_log all;
    for (const planned_motion& m : motions) {
        const axis_log one = free.record(plant, m);
        all.reference.insert(all.reference.end(), one.reference.begin(), one.reference.end());
        all.position.insert(all.position.end(), one.position.begin(), one.position.end());
        all.command.insert(all.command.end(), one.command.begin(), one.command.end());
    }
    return proven_limits(all);
}
double largest(const std::vector<double>& x) {
    double out = 0;
    for (double v : x) out = std::max(out, std::abs(v));
    return out;
}

} // namespace

TEST_CASE("next experiment: no run of a robot joint leaves the travel or the torque that the log has shown, "
          "whatever its gains") {
    const auto motions = standard_motions(shown, rough, of_joint);
    REQUIRE(motions.size() >= 6);
    const auto axis = robot_joint(1);
    const plant_model plant(axis, of_joint.give());
    const proving_ground free(axis, rough, 1e-5, 1e-5, of_joint);
    const proven_limits all = proven(free, plant, motions); // of a log that holds each of them
    proven_limits weak = all, narrow = all;
    weak.command /= 2;
    narrow.low /= 2;
    narrow.high /= 2;
    for (const double stiffness : {0.5, 1.0, 3.0})
        for (const proven_limits& limits : {all, weak, narrow}) {
            const auto of_gains = robot_joint(stiffness);
            const proving_ground ground(of_gains, rough, 1e-5, 1e-5, of_joint, limits);
            std::size_t kept = 0;
            for (const auto& m : motions) {
                CAPTURE(stiffness);
                CAPTURE(m.words);
                const axis_log log = ground.record(plant, m);
                if (log.position.empty()) continue;
                ++kept;
                const auto [low, high] = std::minmax_element(log.position.begin(), log.position.end());
                CHECK(*low > limits.low - 1e-4);
                CHECK(*high < limits.high + 1e-4);
                CHECK(largest(log.command) < 1.11 * limits.command);
            }
            if (stiffness != 1.0) continue;
            if (limits.command == weak.command || limits.high == narrow.high)
                CHECK(kept < motions.size()); // one of them reached what is forbidden now
            else
                CHECK(kept == motions.size()); // as it was shown
        }
}
TEST_CASE(
    "next experiment: a motion is run on the plant with the drive's loops closed, and its force shows the "
    "mass where the motion is strong") {
    constexpr record_scales usual{.travel = 0.2, .speed = 0.25, .command = 300, .count = 1e-6, .corner_Hz = 40};
    for (const char* drive : {R"("kind": "velocity", "velocity_per_V": 0.02)", R"("kind": "velocity")",
                              R"("kind": "position", "position_gain_per_s": 40, "interpolation": "linear")"}) {
        CAPTURE(drive);
        const auto axis = read_machine(driven(drive), "machine.json").axes[0];
        const auto motions = standard_motions({0, 0, 0.1, 0.2, 2}, 0.001, usual);
        const proving_ground ground(axis, 0.001, 1e-6, 4e-7, usual);
        const auto named = [&](const char* words) {
            for (const auto& m : motions)
                if (m.words.starts_with(words)) return m;
            FAIL("no motion " << words);
            return motions.front();
        };
        const auto strong = named("strong accelerations");
        plant_model plant(axis, usual.give());
        const axis_log log = ground.record(plant, strong);
        REQUIRE(log.position.size() == strong.reference.size());
        double error = 0; // it follows
        for (std::size_t k = 0; k < log.position.size(); ++k)
            error = std::max(error, std::abs(log.position[k] - log.reference[k]));
        CHECK(error < 0.02);
        plant.mass *= 1.2; // and shows the mass: the force of the drive differs by its acceleration
        const axis_log heavier = ground.record(plant, strong);
        REQUIRE(!heavier.position.empty());
        CHECK(largest(heavier.command) > 1.1 * largest(log.command));
        const axis_log slow = ground.record(plant, named("slow strokes in"));
        CHECK(largest(slow.command) < 0.5 * largest(log.command));
    }
}
