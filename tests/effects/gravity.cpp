// SPDX-License-Identifier: BSL-1.0
#include "arm.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/init.hpp>
#include <quadrant/diagnosis/model/plant_model.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>
#include <quadrant/diagnosis/write_machine.hpp>

using namespace arms;

namespace {

const char* const key = "gravity_torque_Nm";

/// The first cause is this one, or names it as what it may be as well, and the group is claimed.
bool in_group(const diagnosis_result& d, const std::string& effect) {
    if (d.causes.empty() || d.causes[0].group_probability < 0.5) return false;
    const cause& c = d.causes[0];
    return c.effect == effect ||
           std::find(c.confusable_with.begin(), c.confusable_with.end(), effect) != c.confusable_with.end();
}
std::string file_with(const nlohmann::json& gravity, bool rotary = true) {
    nlohmann::json plant{{"inertia_kg_m2", 2}, {"torque_constant_Nm_per_V", 5}};
    if (!rotary) plant = {{"mass_kg", 200}, {"force_constant_N_per_V", 1000}};
    plant.update(gravity);
    return nlohmann::json{{"schema", "quadrant.machine/1"},
                          {"sample_period_s", 0.001},
                          {"axes", {{"q", {{"plant", plant}, {"tolerance", {{"gravity_torque", 0.1}}}}}}}}
        .dump();
}

} // namespace

TEST_CASE("gravity: it is named with torque and phase, apply writes both, and the corrected machine predicts "
          "other motion") {
    arm real{.gravity = 3.2, .phase = 0.3};
    const auto file = described(real);
    const auto d = diagnose(file, run(real));
    named(d, "gravity", key, 3.2, 0.02);
    CHECK(near(value_of(d.causes[0], "gravity_phase_rad").value, 0.3, 0.03));
    const auto better = apply(file, d);
    CHECK(to_json(better)["axes"]["q"]["plant"].contains(key));
    real.low = -0.8;
    real.high = 2.6;
    const auto other = run(real, 7);
    CHECK(simulate(better, other).axes[0].gap.force_rms_N <
          0.2 * simulate(file, other).axes[0].gap.force_rms_N);
}
TEST_CASE("gravity: an axis whose zero is where the weight stands up has its phase half a turn away" *
          doctest::test_suite("all")) {
    const arm real{.gravity = 1.5, .phase = std::numbers::pi - 0.02};
    const auto d = diagnose(described(real), run(real));
    REQUIRE(claims(d) == std::vector<std::string>{"gravity"});
    CHECK(near(value_of(d.causes[0], key).value, 1.5, 0.02));
    const double phase = value_of(d.causes[0], "gravity_phase_rad").value;
    CHECK(std::abs(std::remainder(phase - real.phase, 2 * std::numbers::pi)) < 0.02);
}
TEST_CASE(
    "gravity: found beside Coulomb friction that the file does not describe either, and both are claimed" *
    doctest::test_suite("all")) {
    const arm real{.gravity = 3.2};
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    const auto d = diagnose(file, run(real));
    CAPTURE(said(d));
    CHECK(claims(d) == std::vector<std::string>{"gravity", "coulomb_friction"});
    CHECK(near(value_of(d.causes[0], key).value, 3.2, 0.02));
    CHECK(near(value_of(d.causes[1], "coulomb_Nm").value, 0.16, 0.05));
}
TEST_CASE("gravity: an arm that moves a few degrees has gravity, a constant torque or a spring, and says so" *
          doctest::test_suite("all")) {
    const arm level{.gravity = 3.2, .low = 1.52, .high = 1.62},
        hanging{.gravity = 3.2, .low = -0.05, .high = 0.05};
    const auto flat = diagnose(described(level), run(level));
    CAPTURE(said(flat));
    CHECK(in_group(flat, "constant_force"));
    CHECK(in_group(flat, "gravity"));
    const auto steep = diagnose(described(hanging), run(hanging));
    CAPTURE(said(steep));
    CHECK(in_group(steep, "position_spring"));
    CHECK(in_group(steep, "gravity"));
}
TEST_CASE("gravity: a constant torque and a spring over a wide angle are not called gravity" *
          doctest::test_suite("all")) {
    arm real{.constant = 0.8};
    named(diagnose(described(real), run(real)), "constant_force", "constant_torque_Nm", 0.8, 0.03);
    real = {.spring = 1.2};
    named(diagnose(described(real), run(real)), "position_spring", "spring_Nm_per_rad", 1.2, 0.03);
}
TEST_CASE("gravity: described, it is no cause inside the tolerance, and its key changes where the weight is "
          "another" *
          doctest::test_suite("all")) {
    const arm real{.gravity = 3.2, .phase = 0.3};
    auto file = described(real);
    file.axes[0].plant.gravity_torque_Nm = 3.1;
    file.axes[0].plant.gravity_phase_rad = 0.3;
    file.axes[0].tolerance.given["gravity_torque"] = 0.05;
    const auto healthy = diagnose(file, run(real));
    CAPTURE(said(healthy));
    CHECK(healthy.verdict <= verdict::within_tolerance);
    file.axes[0].plant.gravity_torque_Nm = 2.2;
    const auto d = diagnose(file, run(real));
    named(d, "gravity", key, 3.2, 0.02);
    CHECK(d.causes[0].described);
    CHECK(*apply(file, d).axes[0].plant.gravity_torque_Nm == doctest::Approx(3.2).epsilon(0.02));
}
TEST_CASE("gravity: a rotary file holds it with a tolerance, a linear one refuses it") {
    const nlohmann::json gravity{{key, 0.67}, {"gravity_phase_rad", -0.02}};
    const auto machine = read_machine(file_with(gravity), "m.json");
    CHECK(plant_model(machine.axes[0], 1e-6).gravity.torque == 0.67);
    CHECK(machine.axes[0].tolerance.of("gravity_torque") == 0.1);
    CHECK(to_json(machine)["axes"]["q"]["plant"]["gravity_phase_rad"] == -0.02);
    CHECK_THROWS_WITH_AS(read_machine(file_with({{"gravity_phase_rad", 1}}), "m.json"),
                         "m.json: axes.q.plant.gravity_phase_rad: needs gravity_torque_Nm", bad_input);
    CHECK_THROWS_WITH_AS(
        read_machine(file_with({{key, 1}}, false), "m.json"),
        "m.json: axes.q.plant.gravity_torque_Nm: only a rotary axis has gravity; this one is linear, "
        "without inertia_kg_m2",
        bad_input);
}
TEST_CASE("gravity: of nothing, or of a billionth, it leaves every gap as without the key" *
          doctest::test_suite("all")) {
    const arm real{.gravity = 3.2};
    const auto log = run(real);
    auto file = described(real);
    const double without = simulate(file, log).axes[0].gap.force_rms_N;
    for (const double torque : {0.0, 3.2e-9}) {
        file.axes[0].plant.gravity_torque_Nm = torque;
        file.axes[0].plant.gravity_phase_rad = 1;
        CHECK(simulate(file, log).axes[0].gap.force_rms_N == doctest::Approx(without).epsilon(1e-6));
    }
}
TEST_CASE("gravity: init estimates it from a log with friction and a coarse, noisy encoder, in the file and in "
          "a note" *
          doctest::test_suite("all")) {
    const arm real{.gravity = 3.2, .phase = 0.3};
    for (const double count : {least_angle, 100 * least_angle}) {
        auto log = run(real);
        for (double& y : log.axes[0].position) y = std::round(y / count) * count;
        init_request r;
        r.values["force-constant"][""] = real.torque_constant;
        r.from_log = true;
        const auto begun = init_machine(r, &log);
        const auto& plant = begun.machine["axes"]["q"]["plant"];
        CAPTURE(plant.dump());
        CHECK(near(plant["inertia_kg_m2"], 0.17, 0.03));
        CHECK(near(plant["gravity_torque_Nm"], 3.2, 0.02));
        CHECK(near(plant["gravity_phase_rad"], 0.3, 0.03));
        CHECK(near(plant["coulomb_Nm"], 0.16, 0.2)); // shares its slope with viscous friction
        CHECK(std::any_of(begun.notes.begin(), begun.notes.end(),
                          [](const std::string& n) { return n.find("gravity 3.2 N m") != n.npos; }));
    }
}
TEST_CASE("gravity: a curve over the angle is no weight beside a constant torque that cancels it") {
    const arm real{.gravity = 3.2, .curve = 0.5, .low = -0.9, .high = 0.9};
    auto file = described(real);
    file.axes[0].plant.gravity_torque_Nm = 3.2;
    file.axes[0].plant.gravity_phase_rad = 0;
    const auto d = diagnose(file, run(real));
    CAPTURE(said(d));
    CHECK(claims(d).empty());
    CHECK(d.verdict > verdict::within_tolerance);
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("cancel here: together they are smaller than either") != note.npos;
    }));
}
