// SPDX-License-Identifier: BSL-1.0
// Long: the machines with two positions: how they are drawn, moved and diagnosed.
// Machines of the trial with two positions an axis, and what the diagnosis says of some of them.
#include "quadrant_gap/trial/chain_files.hpp"

#include <quadrant/diagnosis/chain/diagnose_chain.hpp>
#include <quadrant/diagnosis/chain/link.hpp>
#include <quadrant/diagnosis/compensate.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/write_machine.hpp>

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <sstream>

using namespace quadrant_gap::trial;
namespace diagnosis = quadrant::diagnosis;

namespace {

/// A motor of 40 kg and a load of 60 kg on a screw, without friction and rounding.
chain_truth free_machine() {
    chain_truth a;
    a.mass = 100;
    a.motor_mass = 40;
    a.force_constant = 100;
    a.gears.stiffness = 2e7;
    a.guide.viscous = 400;
    a.velocity_gain = 60;
    a.integral = 600;
    a.position_gain = 10;
    a.filter_Hz = 300;
    return a;
}
diagnosis::machine_log read(const std::string& text) {
    std::istringstream stream(text);
    return diagnosis::read_log(stream, "log.csv");
}
diagnosis::diagnosis_result diagnosed(const drawn_chain& m) {
    const auto machine = diagnosis::read_machine(machine_file(m).dump(), "machine.json");
    const auto log = read(log_file(m, detail::recorded(m, m.truth))),
               holdout = read(log_file(m, detail::recorded(m, m.truth, true)));
    diagnosis::rules one;
    one.threads = 1;
    return diagnosis::diagnose(
        machine, log, &holdout, [](const std::string&) {}, one);
}

/// A machine of the population with a pitch error: the same for one seed, a file that is read, and no word of
/// the effect in it.
void is_drawn(population of, std::uint64_t seed) {
    const planned p{kind::single, {"pitch_error"}, false, false, of};
    const drawn_chain m = draw_chain(seed, 4, p);
    CHECK(m.effects.at(0).size > 1.5);
    const std::string file = machine_file(m).dump();
    CHECK(file == machine_file(draw_chain(seed, 4, p)).dump());
    CHECK(file.find("pitch") == std::string::npos);
    const auto machine = diagnosis::read_machine(file, "machine.json");
    const auto text = log_file(m, detail::recorded(m, m.truth));
    CHECK_NOTHROW(diagnosis::check_match(machine, read(text)));
    const auto again = diagnosis::read_machine(diagnosis::to_json(machine).dump(), "machine.json");
    CHECK(again.axes[0].positions_only == (of == population::kinematic));
    CHECK(truth_of(m).at("effects").at(0).at("effect") == "pitch_error");
}

} // namespace

TEST_CASE(
    "plan: machines with two positions have one axis, every effect in turn, and a single one where others have "
    "a slow stroke") {
    for (const population of : {population::two_encoders, population::kinematic}) {
        std::map<kind, int> kinds;
        std::set<std::string> singles;
        for (const planned& p : plan(5, 60, of)) {
            ++kinds[p.what];
            CHECK_FALSE(p.two_axes);
            if (p.what == kind::single) singles.insert(p.effects.at(0));
            if (p.what == kind::pair) CHECK_FALSE(near_relatives(p.effects.at(0), p.effects.at(1)));
        }
        CHECK(kinds[kind::none] == 18);
        CHECK(kinds[kind::single] == 21);
        CHECK(kinds[kind::poor] == 0);
        CHECK(singles.size() == withheld_from(of).size());
    }
}

TEST_CASE("population: machines with two positions are the same for one seed, read without complaint, and say "
          "nothing of the effect") {
    is_drawn(population::two_encoders, 3);
    is_drawn(population::kinematic, 4);
}

TEST_CASE("population: machines with two positions of other seeds, too" * doctest::test_suite("all")) {
    for (const std::uint64_t seed : {4U, 5U}) is_drawn(population::two_encoders, seed);
    for (const std::uint64_t seed : {3U, 5U}) is_drawn(population::kinematic, seed);
}

TEST_CASE(
    "trial's two masses: a constant force on the load winds the transmission up by force over stiffness") {
    chain_truth a = free_machine();
    a.constant_force = -200;
    const auto r = run_two_masses(a, std::vector<double>(6000, 0.0), 0.0005, 1);
    REQUIRE_FALSE(r.ran_away);
    CHECK(r.scale.back() - r.motor.back() == doctest::Approx(-200 / 2e7).epsilon(1e-3));
    CHECK(r.command.back() == doctest::Approx(2).epsilon(1e-3)); // held by 200 N
}

TEST_CASE("trial's two masses: behind a play the load follows by the play less after a reversal") {
    chain_truth a = free_machine();
    a.gears.play = 2e-4;
    a.guide.coulomb = 50;
    motion way;
    way.stroke(0.05, 0.02, 0.5);
    way.stroke(-0.05, 0.02, 0.5);
    const auto r = run_two_masses(a, way.sampled(0.0005, 10000), 0.0005, 1);
    REQUIRE_FALSE(r.ran_away);
    const double there = r.scale[3000] - r.motor[3000], back = r.scale[8000] - r.motor[8000];
    const double wound_up = 2 * (50 + 400 * 0.02) / 2e7;
    CHECK(back - there == doctest::Approx(2e-4 + wound_up).epsilon(0.01));
}

TEST_CASE("trial's positions: a lag and a delay leave the scale behind by velocity times their time") {
    motion way;
    way.stroke(1, 0.1, 10);
    for (const bool lag : {false, true}) {
        chain_truth a;
        (lag ? a.follows.lag : a.follows.late) = 0.0034;
        const auto r = run_positions(a, way, 0.02, 400, 1);
        CHECK(r.reference[300] - r.scale[300] == doctest::Approx(0.1 * 0.0034).epsilon(1e-6));
    }
}

TEST_CASE(
    "two encoders: play and stiffness both off inside their tolerances, a hold-out log too: nobody is blamed" *
    doctest::test_suite("all")) {
    drawn_chain m = draw_chain(7, 1, {kind::none, {}, false, false, population::two_encoders});
    m.truth = m.described;
    m.described.gears.stiffness *= 1 + 0.9 * m.tolerance.stiffness;
    if (m.truth.gears.play == 0) m.truth.gears.play = 10 * m.described.scale.resolution;
    m.described.gears.play = 0.93 * m.truth.gears.play;
    const auto d = diagnosed(m);
    CHECK(d.verdict <= diagnosis::verdict::within_tolerance);
    CHECK(d.causes.empty());
}

TEST_CASE(
    "two encoders: where the command chatters from sign to sign, the direction of the motion tells the side") {
    drawn_chain m = draw_chain(7, 1, {kind::none, {}, false, false, population::two_encoders});
    m.described.guide.coulomb = 50;
    m.described.gears.play = 0;
    m.truth = m.described;
    m.truth.gears.play = 40 * m.described.scale.resolution;
    const auto machine = diagnosis::read_machine(machine_file(m).dump(), "machine.json");
    auto axis = read(log_file(m, detail::recorded(m, m.truth))).axes.at(0);
    const auto said_of = [&] {
        return diagnosis::chain::diagnose_transmission(machine.axes[0], axis, machine.sample_period_s,
                                                       "log.csv", {}, {});
    };
    CHECK(said_of().notes.empty());
    // Rows of one sign: a force is seen in them, a side that stays is not.
    const double lasts = 0.005 / machine.sample_period_s;
    double largest = 0;
    for (const double u : axis.command) largest = std::max(largest, std::abs(u));
    for (std::size_t k = 0; k < axis.command.size(); ++k)
        axis.command[k] +=
            static_cast<std::size_t>(static_cast<double>(k) / lasts) % 2 ? 3 * largest : -3 * largest;
    const auto said = said_of();
    REQUIRE(said.notes.size() == 1);
    CHECK(said.notes[0].find("changes its sign too often") != std::string::npos);
    REQUIRE_FALSE(said.found.causes.empty());
    CHECK(said.found.causes[0].effect == "lost_motion");
    CHECK(said.found.causes[0].probability > 0.9);
}

TEST_CASE("positions: a head that swings slowly is no missed step, and an effect that the file excludes stays "
          "without "
          "a name" *
          doctest::test_suite("all")) {
    drawn_chain m = draw_chain(7, 2, {kind::none, {}, false, false, population::kinematic});
    m.truth = m.described;
    m.truth.follows.swing = 20 * std::max(m.described.scale.resolution, m.described.motor_encoder.resolution);
    m.truth.follows.swing_Hz = 0.1;
    auto d = diagnosed(m);
    CHECK(d.verdict >= diagnosis::verdict::partly_explained);
    for (const auto& c : d.causes) CHECK_FALSE(claimed(c));

    m.truth = m.described;
    m.truth.gears.lead = 3e-4;
    d = diagnosed(m);
    REQUIRE(d.causes.size() == 1);
    CHECK(d.causes[0].effect == "scale_error");
    m.excluded = {"scale_error"};
    d = diagnosed(m);
    CHECK(d.verdict >= diagnosis::verdict::partly_explained);
    CHECK(d.causes.empty());
    CHECK(std::any_of(d.notes.begin(), d.notes.end(),
                      [](const std::string& n) { return n.find("excluded_effects") != std::string::npos; }));
}

TEST_CASE(
    "positions: a step at each reversal and a table along the travel leave what they were forecast to leave on "
    "another motion" *
    doctest::test_suite("all")) {
    drawn_chain m = draw_chain(7, 3, {kind::none, {}, false, false, population::kinematic});
    m.described.kind = diagnosis::axis_kind::linear;
    m.described.recorded = positions_recorded::counter_and_scale;
    m.described.follows = {};
    m.described.gears.play = 0;
    m.described.motor_encoder.resolution = 1e-6;
    m.described.scale = {1e-6, 2e-7, 0, {}};
    m.truth = m.described;
    m.truth.gears.play = 3e-5;
    m.truth.gears.pitch = {m.truth.gears.turn, {2e-5}, {0.4}};
    const auto machine = diagnosis::read_machine(machine_file(m).dump(), "machine.json");
    const auto d = diagnosed(m);
    REQUIRE(d.causes.size() == 2);
    const auto found =
        diagnosis::compensate(machine, d, read(log_file(m, detail::recorded(m, m.truth)))).axes.at(0);
    REQUIRE(found.compensations.size() == 3);
    const diagnosis::compensation* best = found.best();
    REQUIRE(best);
    CHECK(best->name == "together");
    CHECK(best->settings.at(0).key == "backlash_step_m");
    CHECK(best->settings[0].values[0] == doctest::Approx(3e-5).epsilon(0.05).scale(0));
    // The control of another run of the machine adds these numbers to what it asks for.
    const auto& at = best->settings.at(1).values;
    const auto& add = best->settings.at(2).values;
    const auto table = [&](double x) {
        const double u = std::clamp((x - at[0]) / (at[1] - at[0]), 0.0, static_cast<double>(at.size() - 1));
        const auto k = std::min(static_cast<std::size_t>(u), at.size() - 2);
        return add[k] + (u - static_cast<double>(k)) * (add[k + 1] - add[k]);
    };
    const auto path = m.holdout_motion.sampled(m.period / 20, m.holdout_rows * 20);
    double load = m.truth.gears.carried(path[0]), side = 0, mean = 0, square = 0, n = 0;
    for (std::size_t k = 1; k < path.size(); ++k) {
        if (path[k] != path[k - 1]) side = path[k] > path[k - 1] ? 1 : -1;
        const double asked = path[k] + table(path[k]) + side * best->settings[0].values[0] / 2;
        const double driven = m.truth.gears.carried(asked), half = m.truth.gears.play / 2;
        load = std::clamp(load, driven - half, driven + half);
        if (k < path.size() / 5) continue;
        n += 1, mean += load - path[k], square += (load - path[k]) * (load - path[k]);
    }
    const double rms = std::sqrt(std::max(0.0, square / n - mean * mean / (n * n)));
    CHECK(rms < 0.1 * found.measured.rms_m.value);
    CHECK(best->after.rms_m.value < 0.1 * found.measured.rms_m.value);
    CHECK(best->claimed);
}

TEST_CASE("between slow rows: a late and a lagging sine are those, not their straight lines") {
    const double period = 0.05, w = 2 * std::numbers::pi, late = 0.018;
    std::vector<double> x(400);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::sin(w * static_cast<double>(k) * period);
    const auto delayed = diagnosis::chain::delayed(x, period, late),
               lagged = diagnosis::chain::lagged(x, period, late);
    for (std::size_t k = 100; k < 390; ++k) {
        const double t = static_cast<double>(k) * period;
        CHECK(std::abs(delayed[k] - std::sin(w * (t - late))) < 5e-4); // a straight line: 1e-2
        const double answer = std::sin(w * t - std::atan(w * late)) / std::hypot(1, w * late);
        CHECK(std::abs(lagged[k] - answer) < 5e-4);
    }
}

TEST_CASE("between slow rows: where a motion stops, what follows it late does not overshoot and turn back") {
    std::vector<double> x;
    for (int k = 0; k < 60; ++k) x.push_back(k < 20 ? 0 : k < 40 ? 0.005 * (k - 20) : 0.1);
    for (const double late : {0.004, 0.018, 0.043, 0.061}) {
        const auto delayed = diagnosis::chain::delayed(x, 0.05, late);
        for (std::size_t k = 1; k < x.size(); ++k) {
            CHECK(delayed[k] >= delayed[k - 1]);
            CHECK(delayed[k] <= 0.1);
        }
        // So a play behind it stays where the motion has pushed it.
        CHECK(diagnosis::chain::play_of(delayed, 2e-6).offset.back() == doctest::Approx(-1e-6));
    }
}
