// SPDX-License-Identifier: BSL-1.0
// Long: one call, with effects and controllers of the user, too.
#include "quadrant/diagnosis/simulate.hpp"
#include "quadrant/diagnosis/apply.hpp"
#include "quadrant/diagnosis/controller/cascade_p_pi.hpp"
#include "quadrant/diagnosis/diagnose.hpp"
#include "quadrant/diagnosis/effect/own_effect.hpp"
#include "quadrant/diagnosis/read_diagnosis.hpp"
#include "quadrant/diagnosis/read_machine.hpp"
#include "quadrant/diagnosis/where/controller_box.hpp"
#include "quadrant/diagnosis/write_diagnosis.hpp"
#include "quadrant/diagnosis/write_simulation.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {

/// The machine file of a machine with its values as they are.
machine_description exact(const workshop::machine& m) {
    auto d = workshop::described(m);
    auto& p = d.axes[0].plant;
    p.mass_kg = m.mass;
    p.force_constant_N_per_V = m.force_constant;
    p.viscous_N_s_per_m = m.viscous;
    if (m.coulomb > 0) p.coulomb_N = m.coulomb;
    return d;
}

simulated_axis only(const simulation_result& s) {
    REQUIRE(s.axes.size() == 1);
    return s.axes[0];
}

/// What a residual force holds above the noise: each log has a band of its own, and so a floor of its own [N].
double above_floor(const gap_numbers& g) {
    return std::sqrt(
        std::max(0.0, g.force_rms_N * g.force_rms_N - g.noise_floor_force_rms_N * g.noise_floor_force_rms_N));
}

} // namespace

TEST_CASE("simulate: a machine as described is predicted to the noise, one with another mass is not") {
    const workshop::machine m;
    const auto log = workshop::as_log(workshop::run(m, 4.15));
    auto file = exact(m);
    const auto right = only(simulate(file, log));
    CHECK(right.closed_loop);
    CHECK(right.gap.force_rms_N < 1.5 * right.gap.noise_floor_force_rms_N);
    CHECK(right.gap.position_peak_m < 2e-6);
    CHECK(right.position.size() == log.samples);

    file.axes[0].plant.mass_kg *= 1.2;
    const auto wrong = only(simulate(file, log));
    CHECK(wrong.gap.force_rms_N > 5 * right.gap.force_rms_N);
    CHECK(wrong.gap.position_rms_m > right.gap.position_rms_m);
    CHECK(wrong.gap.command_rms_V > right.gap.command_rms_V);
    // The floor is the sensor's, not the gap's: the same whatever the model lacks, but for the mass that it is
    // told with, and the band, which a heavier axis has narrower: twice differentiated noise grows with f^5/2.
    const double band = wrong.gap.bandwidth_Hz / right.gap.bandwidth_Hz;
    CHECK(band < 1);
    CHECK(wrong.gap.noise_floor_force_rms_N ==
          doctest::Approx(1.2 * std::pow(band, 2.5) * right.gap.noise_floor_force_rms_N).epsilon(0.05));
}

TEST_CASE("simulate: a reference that was logged a row late is read in time, as diagnose reads it") {
    const workshop::machine m;
    auto log = workshop::as_log(workshop::run(m, 4.15));
    const auto in_time = simulate(exact(m), log);
    workshop::stand_later(log.axes[0].reference, 1);
    const auto late = simulate(exact(m), log);
    CHECK(in_time.notes.empty());
    REQUIRE(late.notes.size() == 1);
    CHECK(late.notes[0].find("the reference stands 1 row later in the log") != std::string::npos);
    CHECK(workshop::near(only(late).gap.position_rms_m, only(in_time).gap.position_rms_m, 0.05));
}
TEST_CASE(
    "simulate: a column that the log says is measured is read before the low-pass behind which it stands") {
    const workshop::machine m;
    auto file = exact(m);
    file.axes[0].controller.reset();
    auto log = workshop::as_log(workshop::run(m));
    auto& command = log.axes[0].command;
    for (std::size_t k = 1; k < command.size(); ++k) command[k] += 0.7 * (command[k - 1] - command[k]);
    const auto asked = simulate(file, log);
    log.axes[0].command_is = command_origin::measured;
    const auto measured = simulate(file, log);
    const auto says_so = [](const simulation_result& s) {
        return std::any_of(s.notes.begin(), s.notes.end(),
                           [](const auto& n) { return n.find("as behind a low-pass") != n.npos; });
    };
    CHECK(!says_so(asked));
    CHECK(says_so(measured));
    CHECK(only(measured).gap.force_rms_N < 0.5 * only(asked).gap.force_rms_N);
}
TEST_CASE("simulate: without a controller the force alone is judged") {
    const workshop::machine m;
    auto file = exact(m);
    file.axes[0].controller.reset();
    const auto s = only(simulate(file, workshop::as_log(workshop::run(m, 2.15))));
    CHECK_FALSE(s.closed_loop);
    CHECK(s.position.empty());
    CHECK(s.gap.position_rms_m == 0);
    CHECK(s.gap.force_rms_N > 0);
}

TEST_CASE("simulate: a process that began elsewhere in its cycle is found again") {
    workshop::machine m;
    m.cutting = 30;
    auto file = exact(m);
    auto& p = file.axes[0].process;
    p.fundamental_Hz = m.cutting_frequency;
    p.force_N = {30, 15};
    p.phase_rad = {0.4 + 2.2, 4.4}; // 2.2 rad of the fundamental later than the machine's
    const auto s = only(simulate(file, workshop::as_log(workshop::run(m, 4.15))));
    file.axes[0].process = {};
    const auto none = only(simulate(file, workshop::as_log(workshop::run(m, 4.15))));
    CHECK(above_floor(s.gap) < 0.15 * above_floor(none.gap));
}

TEST_CASE("simulate: a parked axis is left out, a log too short refused") {
    const workshop::machine m;
    auto file = exact(m);
    auto log = workshop::as_log(workshop::run(m, 1));
    file.axes.push_back(file.axes[0]);
    file.axes[1].name = "y";
    log.axes.push_back(log.axes[0]);
    log.axes[1].name = "y";
    log.axes[1].still = true;
    CHECK(simulate(file, log).axes.size() == 1);
    log.samples = 900;
    CHECK_THROWS_AS(simulate(file, log), bad_input);
}

TEST_CASE("simulate: what diagnose forecasts is achieved on another log, within ten points" *
          doctest::test_suite("all")) {
    workshop::machine m;
    m.cogging = 25;
    const auto machine = exact(m);
    const auto d = diagnose(machine, workshop::as_log(workshop::run(m, workshop::strokes)));
    const auto corrected = apply(machine, d);
    CHECK(corrected.axes[0].plant.cogging_N.size() > 0);
    const auto other = workshop::as_log(workshop::run(m, 6.15, 7)); // and swings of 20 mm and 2 mm
    const double before = only(simulate(machine, other)).gap.force_rms_N,
                 after = only(simulate(corrected, other)).gap.force_rms_N;
    const double forecast = 1 - d.axes[0].gap_after.force_rms_N / d.axes[0].gap.force_rms_N;
    CAPTURE(before);
    CAPTURE(after);
    CHECK(forecast > 0.5);
    CHECK(std::abs(1 - after / before - forecast) < 0.1);
}

TEST_CASE("simulate: with the calibrated values the forecast is kept where the machine file is off inside its "
          "tolerance" *
          doctest::test_suite("all")) {
    workshop::machine m;
    m.excess = 40;
    const auto machine = workshop::described(m);
    const auto d = diagnose(machine, workshop::as_log(workshop::run(m, workshop::strokes)));
    REQUIRE(!d.axes[0].calibrated.empty());
    const auto other = workshop::as_log(workshop::run(m, 6.15, 7));
    const double before = above_floor(only(simulate(machine, other)).gap),
                 after = above_floor(only(simulate(apply(machine, d), other)).gap);
    CHECK(std::abs(after / before - above_floor(d.axes[0].gap_after) / above_floor(d.axes[0].gap)) < 0.1);
}

TEST_CASE("simulate: its JSON holds the numbers of each axis") {
    const workshop::machine m;
    const auto s = simulate(exact(m), workshop::as_log(workshop::run(m, 2.15)));
    const auto json = to_json(s);
    CHECK(json["schema"] == "quadrant.simulation/1");
    CHECK(json["axes"]["x"]["gap"]["force_rms_N"] == s.axes[0].gap.force_rms_N);
    CHECK(json["axes"]["x"]["command_unit"] == "V");
}

namespace {

constexpr own_law bellows{.name = "bellows",
                          .exciting_motion = "strokes over the whole travel",
                          .numbers = {{{.key = "bellows_N_per_m2", .low = 0, .high = 500000}}},
                          .law = [](const auto& now, const auto& number, auto&) {
                              return -number[0] * now.position * std::abs(now.position);
                          }};
/// A cable chain: follows the axis by a length, then drags; its numbers are no straight line.
constexpr own_law chain{
    .name = "cable_chain",
    .numbers = {{{.key = "chain_N", .start = 20, .low = 0, .high = 500},
                 {.key = "chain_m", .start = 0.003, .low = 1e-4, .high = 0.1, .logarithmic = true}}},
    .law = [](const auto& now, const auto& number, auto& bent) {
        bent[0] = std::clamp(bent[0] + now.step * now.velocity, -number[1], number[1]);
        return -number[0] * bent[0] / number[1];
    }};
constexpr own_law of_the_list = [] {
    own_law f = bellows;
    f.name = "mass";
    return f;
}();

} // namespace

TEST_CASE("own effect: it is named with its number, is written and read, and the corrected machine predicts "
          "another log" *
          doctest::test_suite("all")) {
    workshop::machine real;
    real.stranger = [](double x, double, double) { return -9000 * x * std::abs(x); };
    auto file = exact(real);
    file.axes[0].own_effects = {own_effect<bellows>, own_effect<chain>};
    const auto d = diagnose(file, workshop::as_log(workshop::run(real, workshop::strokes)));
    CHECK(d.verdict == verdict::explained);
    REQUIRE(d.causes.size() == 1);
    const cause& c = d.causes[0];
    CHECK(c.effect == "bellows");
    CHECK(c.probability > 0.5);
    CHECK_FALSE(c.described);
    const estimate& found = c.parameters.at(0).values.at(0);
    CHECK(workshop::near(found.value, 9000, 0.03));
    CHECK(found.low < found.value);
    CHECK(found.high > found.value);
    CHECK(d.own_effects == std::vector<std::string>{"bellows", "cable_chain"});
    const nlohmann::json written = to_json(d), again = to_json(read_diagnosis(written.dump(), "d.json"));
    CHECK(again == written);

    const auto mended = apply(file, d);
    const auto other = workshop::as_log(workshop::run(real, workshop::three_strokes, 7));
    const auto before = only(simulate(file, other)), after = only(simulate(mended, other));
    CHECK(after.gap.position_rms_m < 0.2 * before.gap.position_rms_m);
    CHECK(after.gap.force_rms_N < 0.2 * before.gap.force_rms_N);
}

TEST_CASE("own controller: with the stock cascade behind it the diagnosis is the same to the bit") {
    workshop::machine real;
    auto file = workshop::described(real);
    real.constant_force = 25;
    const auto log = workshop::as_log(workshop::run(real, 2.2));
    const auto stock = to_json(diagnose(file, log));
    auto& axis = file.axes[0];
    axis.controller = with_cascade(*axis.controller, axis.actuator, workshop::period,
                                   [](const auto& loop) { return own_controller(loop); });
    const auto own = to_json(diagnose(file, log));
    CHECK(stock["causes"].size() > 0);
    CHECK(own.dump() == stock.dump());
}

TEST_CASE("own effect: one that remembers and is no straight line in its numbers" *
          doctest::test_suite("all")) {
    workshop::machine real;
    real.stranger = [bent = 0.0](double, double v, double) mutable {
        bent = std::clamp(bent + v * workshop::period / 20, -0.005, 0.005);
        return -40 * bent / 0.005;
    };
    auto file = exact(real);
    file.axes[0].own_effects = {own_effect<chain>};
    const auto d = diagnose(file, workshop::as_log(workshop::run(real, workshop::strokes)));
    REQUIRE(!d.causes.empty());
    CHECK(d.causes[0].effect == "cable_chain");
    CHECK(workshop::near(d.causes[0].parameters.at(0).values.at(0).value, 40, 0.05));
    CHECK(workshop::near(d.causes[0].parameters.at(1).values.at(0).value, 0.005, 0.05));
}

TEST_CASE("own effect: a machine without it is not blamed for it, nor one with an effect of the list" *
          doctest::test_suite("all")) {
    workshop::machine real;
    auto file = exact(real);
    file.axes[0].own_effects = {own_effect<bellows>, own_effect<chain>};
    CHECK(diagnose(file, workshop::as_log(workshop::run(real, workshop::three_strokes))).causes.empty());
    real.viscous = 600;
    const auto d = diagnose(file, workshop::as_log(workshop::run(real, workshop::strokes)));
    REQUIRE(d.causes.size() == 1);
    CHECK(d.causes[0].effect == "viscous_friction");
}

TEST_CASE("own effect: with a name of the list, or twice the same, it is refused") {
    auto file = exact({});
    const auto log = workshop::as_log(workshop::run({}, 2.1));
    file.axes[0].own_effects = {own_effect<of_the_list>};
    CHECK_THROWS_WITH_AS(diagnose(file, log), "own_effects of axis x: mass is a name of the list",
                         std::invalid_argument);
    file.axes[0].own_effects = {own_effect<bellows>, own_effect<bellows>};
    CHECK_THROWS_WITH_AS(diagnose(file, log), "own_effects of axis x: bellows is there twice",
                         std::invalid_argument);
}
