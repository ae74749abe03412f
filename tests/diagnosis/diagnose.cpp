// SPDX-License-Identifier: BSL-1.0
#include "workshop.hpp"

#include <quadrant/diagnosis/diagnose.hpp>

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {

using workshop::as_log;
using workshop::described;
using workshop::machine;
using workshop::run;

diagnosis_result diagnosed(const machine_description& described_machine, const machine& real) {
    return diagnose(described_machine, as_log(run(real)));
}

/// Names that are claimed: blamed at one half or more.
std::vector<std::string> claims(const diagnosis_result& d) {
    std::vector<std::string> out;
    for (const cause& c : d.causes)
        if (c.probability >= 0.5) out.push_back(c.effect);
    return out;
}

const estimate& value_of(const cause& c, const std::string& key) {
    for (const auto& p : c.parameters)
        if (p.key == key) return p.values.at(0);
    FAIL("no parameter " << key);
    static const estimate none;
    return none;
}

/// The effect is named first and claimed, nothing else is, its parameter is found, and the gap shrinks to the floor.
void named(const diagnosis_result& d, const std::string& effect, const std::string& key, double truth,
           double within) {
    CAPTURE(effect);
    CHECK(std::string(name_of(d.verdict)) == "explained");
    REQUIRE(claims(d) == std::vector{effect});
    const cause& c = d.causes.front();
    CHECK(c.effect == effect);
    CHECK(value_of(c, key).value == doctest::Approx(truth).epsilon(within));
    CHECK(value_of(c, key).low < value_of(c, key).value);
    CHECK(value_of(c, key).high > value_of(c, key).value);
    CHECK(c.gap_after_force_rms_N.value < 0.5 * c.gap_before_force_rms_N.value);
    CHECK(c.shrink.low <= c.shrink.value);
    CHECK(c.shrink.value <= c.shrink.high);
}

/// Something is wrong and no name is claimed for it.
void abstains(const diagnosis_result& d) {
    CHECK(d.verdict >= verdict::partly_explained);
    CHECK(claims(d).empty());
    CHECK(!d.remaining_structure.empty());
}

} // namespace

TEST_CASE("diagnose: a machine that differs by calibration only is within tolerance") {
    const machine real;
    const auto d = diagnosed(described(real), real);
    CHECK(std::string(name_of(d.verdict)) == "within_tolerance");
    CHECK(d.causes.empty());
}

TEST_CASE("diagnose: the machine as described has no gap") {
    const machine real;
    auto file = described(real);
    auto& plant = file.axes[0].plant;
    plant.mass_kg = real.mass;
    plant.force_constant_N_per_V = real.force_constant;
    plant.viscous_N_s_per_m = real.viscous;
    plant.coulomb_N = real.coulomb;
    const auto d = diagnosed(file, real);
    CHECK(std::string(name_of(d.verdict)) == "no_gap");
    CHECK(d.causes.empty());
}

// Each effect alone, by a simulator with another friction law: 3 % on what friction hides, 1 % on the rest.
TEST_CASE("diagnose: Coulomb friction that is not modelled") {
    const machine real;
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    named(diagnosed(file, real), "coulomb_friction", "coulomb_N", 60, 0.03);
}
TEST_CASE("diagnose: viscous friction that is not as described") {
    machine real;
    const auto file = described(real);
    real.viscous = 600;
    named(diagnosed(file, real), "viscous_friction", "viscous_N_s_per_m", 600, 0.03);
}
TEST_CASE("diagnose: Stribeck friction that is not modelled") {
    machine real;
    const auto file = described(real);
    real.excess = 50;
    named(diagnosed(file, real), "stribeck_friction", "stribeck_velocity_m_per_s", 0.004, 0.05);
}
TEST_CASE("diagnose: friction that differs by direction") {
    machine real;
    const auto file = described(real);
    real.viscous_asymmetry = 0.5;
    named(diagnosed(file, real), "asymmetric_friction", "viscous_asymmetry", 0.5, 0.03);
}
TEST_CASE("diagnose: another mass") {
    machine real;
    const auto file = described(real);
    real.mass = 225;
    named(diagnosed(file, real), "mass", "mass_kg", 225, 0.02);
}
TEST_CASE("diagnose: another force constant") {
    machine real;
    const auto file = described(real);
    real.force_constant = 930;
    named(diagnosed(file, real), "force_constant", "force_constant_N_per_V", 930, 0.03);
}
TEST_CASE("diagnose: a command that acts late") {
    machine real;
    const auto file = described(real);
    real.delay = 0.0018;
    named(diagnosed(file, real), "time_delay", "delay_s", 0.0018, 0.02);
}
TEST_CASE("diagnose: a constant force, and its second reading") {
    machine real;
    const auto file = described(real);
    real.constant_force = 25;
    const auto d = diagnosed(file, real);
    named(d, "constant_force", "constant_force_N", 25, 0.03);
    // Coulomb friction that differs by direction is the same model (gap/FORMAT.md), and is said to be.
    CHECK(d.causes.front().confusable_with == std::vector<std::string>{"asymmetric_friction"});
}
TEST_CASE("diagnose: cogging with two harmonics") {
    machine real;
    const auto file = described(real);
    real.cogging = 15;
    real.cogging_second = 5;
    const auto d = diagnosed(file, real);
    named(d, "cogging", "cogging_period_m", 0.03, 0.01);
    CHECK(value_of(d.causes.front(), "cogging_N").value == doctest::Approx(15).epsilon(0.03));
    CHECK(value_of(d.causes.front(), "cogging_phase_rad").value == doctest::Approx(0.7).epsilon(0.03));
}
TEST_CASE("diagnose: another controller, by replay, with its key") {
    machine real;
    const auto file = described(real);
    real.control.position_gain = 88;
    const auto d = diagnosed(file, real);
    named(d, "controller_mismatch", "position_gain_per_s", 88, 0.001);
    CHECK(d.axes[0].where[0].block == "controller");
    CHECK(d.axes[0].where[0].basis == "replay");
}

TEST_CASE("diagnose: two effects, one found on top of the other") {
    machine real;
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    real.cogging = 12;
    const auto d = diagnosed(file, real);
    CHECK(std::string(name_of(d.verdict)) == "explained");
    CHECK(claims(d) == std::vector<std::string>{"coulomb_friction", "cogging"});
    // Added one after the other, the gap falls each time.
    REQUIRE(d.causes.size() == 2);
    CHECK(d.causes[1].gap_before_force_rms_N.value == d.causes[0].gap_after_force_rms_N.value);
    CHECK(d.causes[1].gap_after_force_rms_N.value < d.causes[1].gap_before_force_rms_N.value);
}

// What no suspect is, stays without a name.
TEST_CASE("diagnose: a lag is not called a delay with confidence") {
    machine real;
    const auto file = described(real);
    real.lag = 0.002;
    abstains(diagnosed(file, real));
}
TEST_CASE("diagnose: a spring is not called anything") {
    machine real;
    const auto file = described(real);
    real.spring = 800;
    abstains(diagnosed(file, real));
}
TEST_CASE("diagnose: play is not called friction") {
    machine real;
    const auto file = described(real);
    real.backlash = 8e-6;
    abstains(diagnosed(file, real));
}
TEST_CASE("diagnose: a cause that the owner excludes is not replaced by the nearest name") {
    machine real;
    auto file = described(real);
    file.excluded_effects = {"cogging"};
    real.cogging = 15;
    abstains(diagnosed(file, real));
}
TEST_CASE("diagnose: a sensor coarser than described is seen without dynamics") {
    const machine real;
    auto file = described(real);
    file.axes[0].encoder_resolution_m = workshop::count / 8;
    const auto d = diagnosed(file, real);
    abstains(d);
    CHECK(d.axes[0].where[0].block == "sensor");
}

TEST_CASE("diagnose: without a controller the axis is judged from the command onwards") {
    machine real;
    auto file = described(real);
    file.axes[0].controller.reset();
    real.constant_force = 25;
    const auto d = diagnosed(file, real);
    CHECK(claims(d) == std::vector<std::string>{"constant_force"});
    CHECK(d.axes[0].signals.simulated_position_before.empty());
    CHECK(d.axes[0].gap.position_rms_m == 0);
}

TEST_CASE("diagnose: the forecast is kept on a log of another motion") {
    machine real;
    const auto file = described(real);
    real.viscous = 600;
    // Another motion of the same machine: another part of the programme, other noise.
    const auto whole = run(real, 8.15, 7);
    axis_log second = whole;
    for (auto* column : {&second.reference, &second.position, &second.command})
        column->erase(column->begin() + 8000, column->end());
    const auto log = as_log(run(real)), other = as_log(second);
    const auto d = diagnose(file, log, &other);
    REQUIRE(claims(d) == std::vector<std::string>{"viscous_friction"});
    CHECK(d.axes[0].evaluated_on == "the hold-out log");
    CHECK(d.axes[0].gap_after.force_rms_N < 2 * d.axes[0].gap_after.noise_floor_force_rms_N);
}

TEST_CASE("diagnose: a record too short to leave motions out is refused") {
    const machine real;
    auto log = as_log(run(real, 1.9));
    log.file = "short.csv";
    CHECK_THROWS_WITH_AS(diagnose(described(real), log),
                         "short.csv: 3799 samples are 1.9 s: a diagnosis needs at least 2 s", bad_input);
}

TEST_CASE("diagnose: same input, same output") {
    machine real;
    const auto file = described(real);
    real.mass = 225;
    const auto log = as_log(run(real));
    const auto a = diagnose(file, log), b = diagnose(file, log);
    REQUIRE(a.causes.size() == b.causes.size());
    CHECK(a.causes[0].probability == b.causes[0].probability);
    CHECK(value_of(a.causes[0], "mass_kg").low == value_of(b.causes[0], "mass_kg").low);
    CHECK(a.axes[0].signals.residual_after == b.axes[0].signals.residual_after);
    CHECK(a.remaining_structure == b.remaining_structure);
}
