// SPDX-License-Identifier: BSL-1.0
#include "claims.hpp"

using namespace workshop;

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

TEST_CASE("diagnose: a constant force, and its second reading") {
    machine real;
    const auto file = described(real);
    real.constant_force = 25;
    const auto d = diagnosed(file, real);
    named(d, "constant_force", "constant_force_N", 25, 0.03);
    // Coulomb friction that differs by direction is the same model (gap/FORMAT.md), and is said to be.
    CHECK(d.causes.front().confusable_with == std::vector<std::string>{"asymmetric_friction"});
    // No motion is proposed for one model under two names.
    CHECK(d.next.motion == "none: no motion of this axis tells constant_force and asymmetric_friction apart");
    CHECK(d.next.finding.find("known equivalence") != std::string::npos);
    CHECK(d.next.expected_gain == 0);
    CHECK(d.next.reference.empty());
}
// Swings of one frequency under noise: a lag and a delay are one signal. The machine is that of the other simulator.
TEST_CASE(
    "diagnose: the next experiment names what the log could not, by at least the gain that was forecast") {
    machine real;
    auto file = described(real);
    file.excluded_effects = {"stribeck_friction",
                             "presliding_friction",
                             "position_dependent_friction",
                             "friction_drift",
                             "backlash",
                             "structural_resonance",
                             "cogging",
                             "force_ripple",
                             "encoder_cyclic_error",
                             "cutting_force",
                             "sample_loss"}; // time
    real.lag = 0.001;
    real.noise = 5e-7;
    std::vector<double> swings;
    for (int k = 0; k < 5000; ++k)
        swings.push_back(
            0.02 * (1 - std::cos(2 * std::numbers::pi * std::max(0.0, 2 * (k - 200) * workshop::period))));
    const auto before = diagnose(file, as_log(run(real, 2.5, 3, swings)));
    REQUIRE(!before.causes.empty());
    CHECK(before.causes[0].group_probability > 0.9);
    CHECK(before.causes[0].probability < 0.8);
    const experiment& next = before.next;
    REQUIRE(next.separates.size() == 2);
    CHECK(next.axis == "x");
    CHECK(next.gain_of_log < 15);
    CHECK(next.expected_gain > 30);
    CHECK(next.motion.starts_with("multi-sine"));

    const auto seconds = static_cast<double>(next.reference.size()) * workshop::period;
    const auto log = run(real, seconds, 4, next.reference);
    const auto after = diagnose(file, as_log(log));
    named(after, "actuator_lag", "actuator.lag_s", 0.001, 0.1);
    CHECK(after.causes[0].confusable_with.empty());
    const auto record = prepare(log, workshop::period, workshop::count);
    const search models(record, file.axes[0], {}, {}, [](const std::string&) {});
    const double kept = models.with({&suspect::actuator_lag}).total - models.with({&suspect::time_delay}).total;
    CAPTURE(next.expected_gain);
    CHECK(kept > 0.7 * next.expected_gain);
}
TEST_CASE("diagnose: another controller, by replay, with its key") {
    machine real;
    const auto file = described(real);
    real.control.position_gain = 88;
    const auto d = diagnosed(file, real);
    named(d, "controller_mismatch", "position_gain_per_s", 88, 0.001);
    CHECK(d.axes[0].where[0].block == "controller");
    CHECK(d.axes[0].where[0].basis == "replay");
    auto excluding = file;
    excluding.excluded_effects = {"controller_mismatch"};
    abstains(diagnosed(excluding, real));
}

TEST_CASE("diagnose: two effects, one found on top of the other") {
    machine real;
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    real.cogging = 12;
    const auto log = as_log(run(real, three_strokes));
    std::size_t tried = 0, tried_fast = 0;
    const auto count = [](std::size_t& n) { return [&n](const std::string&) { ++n; }; };
    const auto d = diagnose(file, log, nullptr, count(tried));
    CHECK(std::string(name_of(d.verdict)) == "explained");
    CHECK(claims(d) == std::vector<std::string>{"coulomb_friction", "cogging"});
    // Added one after the other, the gap falls each time.
    REQUIRE(d.causes.size() == 2);
    CHECK(d.causes[1].gap_before_force_rms_N.value == d.causes[0].gap_after_force_rms_N.value);
    CHECK(d.causes[1].gap_after_force_rms_N.value < d.causes[1].gap_before_force_rms_N.value);
    // Shorter looks say the same, with fewer models tried.
    const auto fast = diagnose(file, log, nullptr, count(tried_fast), fast_rules());
    CHECK(fast.verdict == d.verdict);
    CHECK(claims(fast) == claims(d));
    CHECK(tried_fast < tried);
}

TEST_CASE("diagnose: a cause that the owner excludes is not replaced by the nearest name") {
    machine real;
    auto file = described(real);
    file.excluded_effects = {"cogging"};
    real.cogging = 15;
    abstains(diagnosed(file, real, three_strokes));
}
TEST_CASE("diagnose: a sensor coarser than described is seen without dynamics") {
    const machine real;
    auto file = described(real);
    file.axes[0].encoder.resolution_m = workshop::count / 8;
    const auto d = diagnosed(file, real);
    CHECK(std::string(name_of(d.verdict)) == "explained");
    REQUIRE(claims(d) == std::vector<std::string>{"encoder_quantization"});
    CHECK(near(value_of(d.causes.front(), "encoder.resolution_m").value, workshop::count, 1e-3));
    CHECK(d.axes[0].where[0].block == "sensor");
    // Calibration is forecast all the same.
    CHECK(d.axes[0].gap_after.force_rms_N < 0.95 * d.axes[0].gap.force_rms_N);
    file.excluded_effects = {"encoder_quantization"};
    abstains(diagnosed(file, real));
}

TEST_CASE("diagnose: without a controller the axis is judged from the command onwards") {
    machine real;
    auto file = described(real);
    file.axes[0].controller.reset();
    real.constant_force = 25;
    const auto d = diagnosed(file, real, strokes);
    CHECK(claims(d) == std::vector<std::string>{"constant_force"});
    CHECK(d.axes[0].signals.simulated_position_before.empty());
    CHECK(d.axes[0].gap.position_rms_m == 0);
}

TEST_CASE("diagnose: the forecast is kept on a log of another motion") {
    machine real;
    const auto file = described(real);
    real.viscous = 600;
    // Another motion of the same machine: the swings and the multi-sine behind the strokes, with other noise.
    axis_log second = run(real, 8.15, 7);
    for (auto* column : {&second.reference, &second.position, &second.command})
        column->erase(column->begin(), column->begin() + 8050);
    const auto log = as_log(run(real, strokes)), other = as_log(second);
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
    const auto log = as_log(run(real, three_strokes));
    const auto a = diagnose(file, log), b = diagnose(file, log);
    REQUIRE(a.causes.size() == b.causes.size());
    CHECK(a.causes[0].probability == b.causes[0].probability);
    CHECK(value_of(a.causes[0], "mass_kg").low == value_of(b.causes[0], "mass_kg").low);
    CHECK(a.axes[0].signals.residual_after == b.axes[0].signals.residual_after);
    CHECK(a.remaining_structure == b.remaining_structure);
}
