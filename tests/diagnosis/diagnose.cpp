// SPDX-License-Identifier: BSL-1.0
// Long: one call: a case for each thing that a diagnosis may say.
#include "claims.hpp"

#include <quadrant/diagnosis/effect/effect_list.hpp>
#include <quadrant/diagnosis/next/blind_spots.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

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

TEST_CASE("diagnose: a delay that splits a period leaves no more force than one of whole periods" *
          doctest::test_suite("all")) {
    const auto left_by = [](double delay) {
        machine real;
        real.delay = delay;
        real.coulomb = 0; // friction laws differ between simulation and model, and that force with the delay
        auto file = described(real);
        auto& plant = file.axes[0].plant;
        plant.mass_kg = real.mass;
        plant.force_constant_N_per_V = real.force_constant;
        plant.viscous_N_s_per_m = real.viscous;
        return diagnosed(file, real).axes[0].gap.force_rms_N;
    };
    const double whole = left_by(0.0005);
    for (const double delay : {0.00037, 0.00073}) CHECK(left_by(delay) < 1.2 * whole);
}

TEST_CASE("diagnose: a value that its tolerance stops is told, when no effect may take its place" *
          doctest::test_suite("all")) {
    machine real;
    auto file = described(real);
    file.axes[0].plant.mass_kg = real.mass * 1.05; // beyond the 2 % that the owner states
    file.excluded_effects = {"mass", "force_constant"};
    const auto d = diagnosed(file, real);
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("the calibrated mass stops at the end of its tolerance") != std::string::npos;
    }));
}

TEST_CASE("diagnose: a constant force, and its second reading") {
    machine real;
    const auto file = described(real);
    real.constant_force = 25;
    const auto d = diagnosed(file, real);
    named(d, "constant_force", "constant_force_N", 25, 0.03);
    // Coulomb friction that differs by direction is the same model (docs/formats.md), and is said to be.
    CHECK(d.causes.front().confusable_with == std::vector<std::string>{"asymmetric_friction"});
    // No motion is proposed for one model under two names.
    CHECK(d.next.motion == "none: no motion of this axis distinguishes constant force and "
                           "friction that differs by direction");
    CHECK(d.next.finding.find("known equivalence") != std::string::npos);
    CHECK(d.next.expected_gain == 0);
    CHECK(d.next.reference.empty());
}
TEST_CASE("diagnose: what is smaller than what every law of friction is wrong by is no claim" *
          doctest::test_suite("all")) {
    machine real;
    auto file = described(real);
    file.axes[0].plant.coulomb_N = real.coulomb;
    real.cogging = 0.02 * real.coulomb;
    const auto slight = diagnosed(file, real);
    CAPTURE(said(slight));
    CHECK(claims(slight).empty());
    CHECK(std::string(name_of(slight.verdict)) == "within_tolerance");
    real.cogging = 0.2 * real.coulomb;
    named(diagnosed(file, real), "cogging", "cogging_N", 0.2 * real.coulomb, 0.1);
}

TEST_CASE("diagnose: friction's law is wrong by a force, and a delay is claimed however small its force is" *
          doctest::test_suite("all")) {
    machine real;
    real.coulomb = 400;
    auto file = described(real);
    file.axes[0].plant.coulomb_N = real.coulomb;
    real.delay += 0.0003;
    named(diagnosed(file, real), "time_delay", "delay_s", real.delay, 0.05);
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

TEST_CASE("diagnose: a command measured behind the amplifier is no mismatch of the controller") {
    machine real;
    auto file = described(real);
    file.axes[0].actuator.command_is = quadrant::diagnosis::command_origin::measured;
    real.control.position_gain = 88;
    const auto d = diagnosed(file, real);
    CHECK(d.causes.empty());
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("nothing is said of the controller") != std::string::npos;
    }));
}
namespace {
/// A clock that a test turns.
quadrant::diagnosis::rules::clock::time_point its_now{};
} // namespace
TEST_CASE("diagnose: when the time is up before anything was tried, it says what it did not try") {
    machine real;
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    quadrant::diagnosis::rules at_once;
    at_once.until = its_now;
    at_once.now = [] { return its_now; };
    const auto log = as_log(run(real));
    const auto d = diagnose(
        file, log, nullptr, [](const std::string&) {}, at_once);
    CHECK(d.axes[0].cut);
    CHECK(d.axes[0].gap.force_rms_N > 1);
    CHECK(d.causes.empty());
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("not tried beside what was found") != std::string::npos &&
               note.find("Coulomb friction") != std::string::npos;
    }));
    const auto whole = diagnose(file, log);
    CHECK_FALSE(whole.axes[0].cut);
    CHECK(whole.causes.at(0).effect == "coulomb_friction");
}
TEST_CASE("diagnose: names that the time did not allow count against what was found" *
          doctest::test_suite("all")) {
    using quadrant::diagnosis::rules;
    machine real;
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    real.cogging = 40;
    const auto log = as_log(run(real));
    rules in_time;
    in_time.now = [] { return its_now; };
    in_time.until = its_now + std::chrono::hours(1);
    // The second cause is found, and the time is up when its rivals would be tried.
    const auto d = diagnose(
        file, log, nullptr,
        [&](const std::string& said) {
            if (said.find("Coulomb friction, cogging") != std::string::npos ||
                said.find("cogging, Coulomb friction") != std::string::npos)
                its_now = in_time.until;
        },
        in_time);
    const auto whole = diagnose(file, log);
    REQUIRE(d.causes.size() == 2);
    REQUIRE(whole.causes.size() == 2);
    CHECK(d.axes[0].cut);
    CHECK(std::any_of(d.causes.begin(), d.causes.end(), [](const cause& c) { return c.probability < 0.8; }));
    for (const cause& c : whole.causes) CHECK(c.probability > 0.9);
}

TEST_CASE("diagnose: two effects, one found on top of the other" * doctest::test_suite("all")) {
    machine real;
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    real.cogging = 12;
    const auto log = as_log(run(real, three_strokes));
    std::size_t tried = 0, tried_fast = 0;
    const auto counted = [](std::size_t& n) { return [&n](const std::string&) { ++n; }; };
    const auto d = diagnose(file, log, nullptr, counted(tried));
    CHECK(std::string(name_of(d.verdict)) == "explained");
    CHECK(claims(d) == std::vector<std::string>{"coulomb_friction", "cogging"});
    // Added one after the other, the gap falls each time.
    REQUIRE(d.causes.size() == 2);
    CHECK(d.causes[1].gap_before_force_rms_N.value == d.causes[0].gap_after_force_rms_N.value);
    CHECK(d.causes[1].gap_after_force_rms_N.value < d.causes[1].gap_before_force_rms_N.value);
    // Shorter looks say the same, with fewer models tried.
    const auto fast = diagnose(file, log, nullptr, counted(tried_fast), fast_rules());
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
TEST_CASE("diagnose: what the owner excludes speaks against a name that stands in for it, and is told" *
          doctest::test_suite("all")) {
    machine real;
    auto file = described(real);
    real.lag = 0.004;
    const auto named_by = [](const diagnosis_result& d) {
        return std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
            return note.find("current-loop lag, which the machine file excludes, explains") != note.npos;
        });
    };
    const auto free = diagnosed(file, real);
    CHECK(claims(free) == std::vector<std::string>{"actuator_lag"});
    CHECK_FALSE(named_by(free));
    file.excluded_effects = {"cogging", "time_delay"}; // rightly: it costs the name nothing
    const auto right = diagnosed(file, real);
    REQUIRE(claims(right) == std::vector<std::string>{"actuator_lag"});
    CHECK(right.causes.front().probability > 0.9);
    file.excluded_effects = {"actuator_lag"};
    const auto wrong = diagnosed(file, real);
    CHECK(claims(wrong).empty());
    CHECK(named_by(wrong));
}
TEST_CASE("diagnose: what shows in the motion of the hold-out log only is found there, and judged on the log") {
    const auto highest = [](const axis_log& log) {
        double most = 0;
        for (double u : log.command) most = std::max(most, std::abs(u));
        return most;
    };
    machine real;
    const auto file = described(real);
    std::vector<double> gentle(5000),
        brisk(5000); // one stroke each way and more, slowly, and four times as fast
    for (std::size_t k = 0; k < gentle.size(); ++k) {
        const double t = static_cast<double>(k) * workshop::period;
        gentle[k] = 0.03 * (1 - std::cos(5 * t)) + 0.005 * (1 - std::cos(11 * t));
        brisk[k] = 0.03 * (1 - std::cos(20 * t)) + 0.005 * (1 - std::cos(44 * t));
    }
    const double reached = 0.5 * highest(run(real, 2.5, 1, brisk));
    REQUIRE(highest(run(real, 2.5, 1, gentle)) < reached);
    real.drive_limit = reached;
    const auto log = as_log(run(real, 2.5, 1, gentle)), holdout = as_log(run(real, 2.5, 2, brisk));
    const auto d = diagnose(file, log, &holdout);
    CAPTURE(said(d));
    CHECK(claims(d) == std::vector<std::string>{"actuator_saturation"});
    CHECK(d.axes[0].evaluated_on == "the log, fitted to the hold-out log");
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("fitted to the hold-out log and judged on the log") != note.npos;
    }));
    const auto other = diagnose(file, holdout, &log); // nothing to exchange
    CHECK(claims(other) == claims(d));
    CHECK(other.axes[0].evaluated_on == "the hold-out log");
}
TEST_CASE("diagnose: a sensor coarser than described is seen without dynamics" * doctest::test_suite("all")) {
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

TEST_CASE("diagnose: the forecast is kept on a log of another motion" * doctest::test_suite("all")) {
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

TEST_CASE("diagnose: a short record is refused only where not one block of it can be scored") {
    const machine real;
    auto log = as_log(run(real, 0.01));
    log.file = "short.csv";
    std::string said;
    try {
        diagnose(described(real), log);
    } catch (const bad_input& e) {
        said = e.what();
    }
    CHECK(said.starts_with("short.csv: " + std::to_string(log.samples) +
                           " samples of axis x: a diagnosis needs "));
    CHECK(said.ends_with(" in a row, some to start the observer and a block to score"));
    for (const double seconds : {0.11, 0.2, 0.5, 1.0}) {
        CAPTURE(seconds);
        const auto d = diagnose(described(real), as_log(run(real, seconds)));
        CHECK(claims(d).empty());
        CHECK(std::isfinite(d.axes[0].gap.force_rms_N));
    }
}

TEST_CASE("diagnose: one stroke of under a second names a cause that it shows, and a note says that it is one "
          "motion") {
    machine real;
    const auto file = described(real);
    real.mass *= 1.3;
    auto log = run(real, three_strokes);
    for (auto* column : {&log.reference, &log.position, &log.command}) { // the first of motion(), 0.1 to 0.9 s
        column->resize(1800);
        column->erase(column->begin(), column->begin() + 210);
    }
    const auto d = diagnose(file, as_log(log));
    CHECK(claims(d) == std::vector<std::string>{"mass"});
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.starts_with("axis x: the record holds one motion, which is cut into 5 pieces");
    }));
}

TEST_CASE("diagnose: of a record that goes back once, no piece that is left out takes a direction with it" *
          doctest::test_suite("all")) {
    constexpr double there_and_back = 1.85; // of motion() [s]
    machine real;
    real.coulomb = 0;
    const auto file = described(real);
    real.coulomb = machine{}.coulomb;
    real.viscous_asymmetry = 0.3;
    CHECK(claims(diagnosed(file, real, there_and_back)) ==
          std::vector<std::string>{"coulomb_friction", "asymmetric_friction"}); // no drag beside them
    real.viscous_asymmetry = 0;
    real.constant_force = 30;
    const auto d = diagnosed(file, real, there_and_back);
    REQUIRE(claims(d) == std::vector<std::string>{"coulomb_friction", "constant_force"});
    // At one speed a friction that differs by direction is the same force.
    CHECK(d.causes[1].confusable_with == std::vector<std::string>{"asymmetric_friction"});
}

TEST_CASE("diagnose: same numbers, same result to the bit, whether they are metres or radians") {
    machine real;
    auto file = described(real);
    real.constant_force = 25;
    auto log = as_log(run(real, three_strokes));
    file.excluded_effects = {"gravity"}; // only an angle can have it
    const auto linear = diagnose(file, log);
    file.axes[0].kind = log.axes[0].kind = axis_kind::rotary;
    const auto rotary = diagnose(file, log);
    REQUIRE(linear.causes.size() == rotary.causes.size());
    REQUIRE(!rotary.causes.empty());
    CHECK(rotary.axes[0].signals.residual_after == linear.axes[0].signals.residual_after);
    CHECK(value_of(rotary.causes[0], "constant_torque_Nm").low ==
          value_of(linear.causes[0], "constant_force_N").low);
    // Number by number the two files are one; the rotary one speaks of no metre and no newton.
    const auto numbers = [](const diagnosis_result& d) {
        std::vector<std::string> out;
        const auto flat = to_json(d).flatten();
        for (const auto& [path, value] : flat.items())
            // The owner's word on gravity is weighed where there can be any.
            if (value.is_number() && !path.ends_with("probability")) out.push_back(value.dump());
        return out;
    };
    CHECK(numbers(rotary) == numbers(linear));
    const auto json = to_json(rotary);
    const auto flat = json.flatten();
    for (const auto& item : flat.items()) {
        const std::string& path = item.key();
        CAPTURE(path);
        for (const char* of_a_line : {"_m", "_N", "_per_m", "_per_s2", "_kg"})
            CHECK_FALSE(path.ends_with(of_a_line));
        CHECK(path.find("_N_") == path.npos);
        CHECK(path.find("force_rms") == path.npos);
    }
    CHECK(json["axes"]["x"]["gap"]["torque_rms_Nm"] == linear.axes[0].gap.force_rms_N);
    CHECK(json["axes"]["x"]["kind"] == "rotary");
    CHECK(rotary.axes[0].where[1].finding.find(" N ") == std::string::npos);
}

TEST_CASE(
    "diagnose: what the encoder cannot know of itself is said where machine and simulation agree, or it is "
    "suspected" *
    doctest::test_suite("all")) {
    axis_result a;
    a.name = "x";
    cause c;
    c.axis = "x";
    c.effect = "cogging";
    for (const verdict v : {verdict::no_gap, verdict::within_tolerance, verdict::explained}) {
        a.verdict = v;
        CHECK(unseen_by(a, {c}).size() == blind_spots_of_a_line.size());
    }
    a.verdict = verdict::partly_explained;
    CHECK(unseen_by(a, {c}).empty());
    c.confusable_with = {"encoder_cyclic_error"};
    REQUIRE(unseen_by(a, {c}).size() == 3);
    CHECK(unseen_by(a, {c})[0].instrument.find("laser interferometer") != std::string::npos);
    c.axis = "y";
    CHECK(unseen_by(a, {c}).empty());
    a.verdict = verdict::explained;
    a.kind = axis_kind::rotary;
    CHECK(unseen_by(a, {})[0].instrument.find("autocollimator") != std::string::npos);
}

TEST_CASE("diagnose: a command in newtons is searched on its own scale, as one in volts" *
          doctest::test_suite("all")) {
    machine real;
    auto file = described(real);
    file.axes[0].controller.reset();
    for (const std::string_view e : names_of_effects()) // what is left is enough to be wrong about
        if (e != "cogging" && e != "constant_force" && e != "position_spring")
            file.excluded_effects.emplace_back(e);
    real.cogging = 12;
    auto log = as_log(run(real, three_strokes));
    for (double& u : log.axes[0].command) u *= file.axes[0].plant.force_constant_N_per_V;
    log.axes[0].command_unit = file.axes[0].command_unit = "N";
    file.axes[0].plant.force_constant_N_per_V = 1; // its tolerance stays: the machine is the same
    const auto d = diagnose(file, log);
    named(d, "cogging", "cogging_N", 12, 0.03);
}
