// SPDX-License-Identifier: BSL-1.0
#include "diagnosis/claims.hpp"
#include "quadrant_gap/words.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/model/plant_model.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>
#include <quadrant/diagnosis/write_machine.hpp>

using namespace workshop;

namespace {

const char* const key = "quadratic_N_s2_per_m2";

/// A machine of another simulator with this drag; its machine file says nothing of it.
machine with_drag(double q) {
    machine real;
    real.stranger = [q](double, double v, double) { return -q * v * std::abs(v); };
    return real;
}

std::string file_with(const nlohmann::json& drag, bool rotary = false, double tolerance = 0.05) {
    nlohmann::json plant{{"mass_kg", 200}, {"force_constant_N_per_V", 1000}, {key, drag}};
    if (rotary)
        plant = {{"inertia_kg_m2", 2}, {"torque_constant_Nm_per_V", 5}, {"quadratic_Nm_s2_per_rad2", drag}};
    return nlohmann::json{{"schema", "quadrant.machine/1"},
                          {"sample_period_s", 0.001},
                          {"axes", {{"x", {{"plant", plant}, {"tolerance", {{"quadratic", tolerance}}}}}}}}
        .dump();
}

} // namespace

TEST_CASE("quadratic drag: it is named with its number, apply writes it, and the corrected machine predicts "
          "another log" *
          doctest::test_suite("all")) {
    const machine real = with_drag(3000);
    const auto file = described(real);
    const auto d = diagnose(file, as_log(run(real, strokes)));
    named(d, "quadratic_drag", key, 3000, 0.03);
    const auto better = apply(file, d);
    CHECK(to_json(better)["axes"]["x"]["plant"].contains(key));
    const auto other = as_log(run(real, three_strokes, 7));
    CHECK(simulate(better, other).axes[0].gap.force_rms_N <
          0.3 * simulate(file, other).axes[0].gap.force_rms_N);
}
TEST_CASE("quadratic drag: more viscous friction is not called drag" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.viscous = 600;
    named(diagnose(file, as_log(run(real, strokes))), "viscous_friction", "viscous_N_s_per_m", 600, 0.03);
}
TEST_CASE("quadratic drag: a machine whose file has it is not blamed for it, also with another number inside "
          "the tolerance" *
          doctest::test_suite("all")) {
    const machine real = with_drag(3000);
    auto file = described(real);
    for (const double said : {3000.0, 2940.0}) {
        file.axes[0].laws = {{effect_named("quadratic_drag")->law, {said}}};
        file.axes[0].tolerance.given["quadratic"] = 0.05;
        const auto d = diagnose(file, as_log(run(real, three_strokes)));
        CAPTURE(said);
        CHECK(d.verdict <= verdict::within_tolerance);
    }
}
TEST_CASE("quadratic drag: a machine file holds it, with a tolerance, for linear and rotary axes") {
    const auto machine = read_machine(file_with(40), "m.json");
    CHECK(plant_model(machine.axes[0], 2e-7).own.empty() == false);
    CHECK(machine.axes[0].tolerance.of("quadratic") == 0.05);
    CHECK(to_json(machine)["axes"]["x"]["plant"][key] == 40);
    const auto turning = to_json(read_machine(file_with(40, true), "m.json"));
    CHECK(turning["axes"]["x"]["plant"]["quadratic_Nm_s2_per_rad2"] == 40);
    CHECK_THROWS_WITH_AS(read_machine(file_with(-1), "m.json"),
                         "m.json: axes.x.plant.quadratic_N_s2_per_m2: must be a number >= 0", bad_input);
}
TEST_CASE("quadratic drag: pages say it in words") {
    CHECK(quadrant_gap::name_of_effect("quadratic_drag") == "drag with the square of the speed");
    CHECK(quadrant_gap::lines_of(parameter_estimate{"quadratic_N_s2_per_m2", {{40, 38, 42}}})[0] ==
          "quadratic: 40 N s²/m² (38 to 42)");
}
