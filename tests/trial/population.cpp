// SPDX-License-Identifier: BSL-1.0
#include "quadrant_gap/trial/files.hpp"

#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <sstream>

using namespace quadrant_gap::trial;

TEST_CASE("plan: the shares that were promised, every effect in turn, no two near relatives in one machine") {
    const auto all = plan(5, 200);
    std::map<kind, int> kinds;
    std::set<std::string> singles;
    int two_axes = 0, slow_none = 0;
    for (const planned& p : all) {
        ++kinds[p.what];
        two_axes += p.two_axes;
        slow_none += p.what == kind::none && p.slow_only;
        if (p.what == kind::single) singles.insert(p.effects.at(0));
        if (p.what == kind::removed) CHECK_FALSE(has_a_twin(p.effects.at(0)));
        if (p.what == kind::pair) CHECK_FALSE(near_relatives(p.effects.at(0), p.effects.at(1)));
        for (const std::string& e : p.effects)
            if (e == "cross_coupling") CHECK(p.two_axes);
    }
    CHECK(kinds[kind::none] == 60);
    CHECK(kinds[kind::unknown] == 20);
    CHECK(kinds[kind::pair] == 30);
    CHECK(kinds[kind::removed] == 20);
    CHECK(kinds[kind::poor] == 10);
    CHECK(kinds[kind::single] == 60);
    CHECK(slow_none == 10);
    CHECK(singles.size() == withheld_effects().size());
    CHECK(two_axes >= 10);
}

TEST_CASE("plan: a machine is the same in a population of any size") {
    const auto small = plan(9, 20), large = plan(9, 60);
    for (std::size_t k = 0; k < small.size(); ++k) CHECK(small[k].effects == large[k].effects);
}

TEST_CASE("population: the same seed gives the same files, byte for byte; another seed others") {
    const planned p{kind::single, {"cogging"}, false, false};
    const drawn_machine a = draw(3, 4, p), b = draw(3, 4, p), c = draw(4, 4, p);
    const auto log = [](const drawn_machine& m) {
        return log_file(m, run(m.truth, m.log_reference, m.period, m.noise_seed), m.noise_seed);
    };
    CHECK(machine_file(a).dump() == machine_file(b).dump());
    CHECK(truth_of(a).dump() == truth_of(b).dump());
    CHECK(log(a) == log(b));
    CHECK(machine_file(a).dump() != machine_file(c).dump());
}

TEST_CASE("population: the files are read without complaint, and say nothing of the effect") {
    for (const char* effect : {"coulomb_friction", "cross_coupling"}) {
        CAPTURE(effect);
        const drawn_machine m =
            draw(11, 2, {kind::single, {effect}, std::string(effect) == "cross_coupling", false});
        const std::string file = machine_file(m).dump(2);
        CHECK(file.find(effect) == std::string::npos);
        CHECK(file.find("cogging_N") == std::string::npos);
        CHECK(file.find("cyclic") == std::string::npos);
        const auto machine = quadrant::diagnosis::read_machine(file, "machine.json");
        const auto text = log_file(m, run(m.truth, m.log_reference, m.period, m.noise_seed), m.noise_seed);
        std::istringstream stream(text);
        const auto log = quadrant::diagnosis::read_log(stream, "log.csv");
        CHECK_NOTHROW(quadrant::diagnosis::check_match(machine, log));
        CHECK(log.samples == m.log_reference[0].size());
    }
}

TEST_CASE(
    "population: an effect is as large as was asked, in clouds, and the machine stays in its tolerances") {
    const drawn_machine m = draw(21, 6, {kind::poor, {"constant_force"}, false, true});
    CHECK(m.effects.at(0).size >= 1.2);
    CHECK(m.effects.at(0).size < 15);
    CHECK(m.cloud > 0);
    const double moved = m.truth[0].mechanics.mass / m.described[0].mechanics.mass - 1;
    CHECK(std::abs(moved) <= m.tolerance.mass);
    CHECK(moved != 0);
}

TEST_CASE(
    "population: an effect whose law is in its record gets into a machine by that law, at the size asked for") {
    std::size_t tried = 0;
    for (const auto* e : withheld_effects()) {
        if (!e->law) continue;
        CAPTURE(e->name);
        const drawn_machine m = draw(5, 7, {kind::poor, {std::string(e->name)}, false, false});
        REQUIRE(m.truth[0].laws.size() == 1);
        CHECK(m.truth[0].laws[0].law == e->law);
        CHECK(m.effects.at(0).size >= 1.2);
        for (const auto& key : e->keys) CHECK(m.effects[0].parameters.contains(std::string(key.name)));
        CHECK(m.described[0].laws.empty());
        ++tried;
    }
    CHECK(tried > 0);
}

TEST_CASE("population: logs of every kind are read without complaint, and are of their kind") {
    for (std::size_t n = 0; n < names_of_logs.size(); ++n) {
        const auto how = static_cast<logs>(n);
        CAPTURE(names_of_logs[n]);
        const drawn_machine m = draw(17, 3, {kind::none, {}, false, false, population::current, how});
        const auto text = log_file(m, run(m.truth, m.log_reference, m.period, m.noise_seed), m.noise_seed);
        const auto machine = quadrant::diagnosis::read_machine(machine_file(m).dump(2), "machine.json");
        std::istringstream stream(text);
        const auto log = quadrant::diagnosis::read_log(stream, "log.csv");
        CHECK_NOTHROW(quadrant::diagnosis::check_match(machine, log));
        const auto rows = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1;
        CHECK((rows < m.log_reference[0].size()) == (how == logs::gaps));
        CHECK((machine.axes[0].encoder.resolution_m > 0.99e-6) == (how == logs::coarse));
        CHECK((machine.axes[0].actuator.command_is == quadrant::diagnosis::command_origin::measured) ==
              (how == logs::measured));
        CHECK(log.axes[0].has_reference == (how != logs::no_reference));
        std::set<std::string> steps; // of the first rows' stamps
        std::istringstream again(text);
        std::string line;
        std::getline(again, line);
        for (double before = -1; steps.size() < 3 && std::getline(again, line);) {
            const double t = std::stod(line);
            if (before >= 0 && how != logs::gaps) steps.insert(fmt::format("{:.6f}", t - before));
            before = t;
        }
        CHECK((steps.size() == 3) == (how == logs::jitter));
    }
}

TEST_CASE("plan: logs that cannot show an effect do not hold it") {
    for (const planned& p : plan(3, 100, population::current, logs::measured))
        for (const std::string& e : p.effects) CHECK(shows(logs::measured, *effect_named(e)));
    for (const planned& p : plan(3, 100, population::current, logs::no_reference))
        for (const std::string& e : p.effects) CHECK(e != "controller_mismatch");
}
TEST_CASE(
    "population: machines of every drive are read without complaint, with the columns that their drive takes" *
    doctest::test_suite("all")) {
    for (const population of :
         {population::velocity_p, population::velocity_pi, population::position, population::position_servo}) {
        CAPTURE(populations[static_cast<std::size_t>(of)]);
        const auto singles = withheld_effects(drive_of(of));
        CHECK(std::any_of(singles.begin(), singles.end(), [](const auto* e) { return e->box == "drive"; }));
        for (const planned& p : plan(5, 20, of)) {
            CHECK_FALSE(p.two_axes);
            for (const std::string& e : p.effects) CHECK(fits(*effect_named(e), drive_of(of)));
        }
        const drawn_machine m = draw(3, 4, {kind::single, {"drive_gain"}, false, false, of});
        const auto machine = quadrant::diagnosis::read_machine(machine_file(m).dump(), "machine.json");
        CHECK(machine.axes[0].drive.kind == drive_of(of));
        std::istringstream text(
            log_file(m, run(m.truth, m.log_reference, m.period, m.noise_seed), m.noise_seed));
        CHECK_NOTHROW(check_match(machine, quadrant::diagnosis::read_log(text, "log.csv")));
        CHECK(m.effects.at(0).size > 0.1);
    }
}

TEST_CASE(
    "population: behind a drive with loops of its own the current is logged with its force constant, and a "
    "wrong constant shows in it" *
    doctest::test_suite("all")) {
    using quadrant::diagnosis::drive_kind;
    const auto holds = [](const auto& list) {
        return std::any_of(list.begin(), list.end(), [](const auto* e) { return e->name == "force_constant"; });
    };
    for (const population of : {population::velocity_pi, population::position}) {
        CAPTURE(populations[static_cast<std::size_t>(of)]);
        CHECK(can_be_logged(of, logs::measured));
        CHECK(holds(withheld_from(of, logs::measured)));
        CHECK_FALSE(holds(withheld_from(of)));
        drawn_machine m = draw(3, 4, {kind::single, {"force_constant"}, false, false, of, logs::measured});
        // The mean over a row, as the force is recorded: set-points that step as rows begin make the current of
        // that moment another one than the row's.
        m.truth[0].drive.tap_is_mean = true;
        const auto machine = quadrant::diagnosis::read_machine(machine_file(m).dump(), "machine.json");
        CHECK(machine.axes[0].command_unit == "A");
        const auto record = run(m.truth, m.log_reference, m.period, m.noise_seed);
        std::istringstream text(log_file(m, record, m.noise_seed));
        const auto log = quadrant::diagnosis::read_log(text, "log.csv");
        CHECK_NOTHROW(check_match(machine, log));
        const double wrong = m.truth[0].actuator.force_constant / m.described[0].actuator.force_constant;
        CHECK(std::abs(wrong - 1) > m.tolerance.force_constant);
        CHECK(m.effects.at(0).size > 0.1);
        // Where no command was logged the current stands in its place.
        const auto& current = log.axes[0].effort.empty() ? log.axes[0].command : log.axes[0].effort;
        REQUIRE(current.size() == record[0].force.size());
        double by = 0, of_force = 0; // slope of what the file takes the current for over the force
        for (std::size_t k = 0; k < current.size(); ++k) {
            by += current[k] * m.described[0].actuator.force_constant * record[0].force[k];
            of_force += std::pow(record[0].force[k], 2);
        }
        CHECK(by / of_force == doctest::Approx(1 / wrong).epsilon(0.01));
    }
    const drawn_machine servo =
        draw(3, 4, {kind::none, {}, false, false, population::position_servo, logs::measured});
    CHECK(servo.described[0].drive.tapped);
    CHECK_FALSE(can_be_logged(population::velocity_p, logs::coarse));
    CHECK_FALSE(can_be_logged(population::joint, logs::measured));
    CHECK_FALSE(can_be_logged(population::kinematic, logs::measured));
}

TEST_CASE(
    "population: a joint is rotary, weighs, and is read without complaint; its loop holds it where it begins") {
    for (const planned& p : plan(5, 20, population::joint)) CHECK_FALSE(p.two_axes);
    const drawn_machine m = draw(3, 4, {kind::single, {"payload_mass"}, false, false, population::joint});
    const auto machine = quadrant::diagnosis::read_machine(machine_file(m).dump(), "machine.json");
    const auto& axis = machine.axes.at(0);
    CHECK(axis.kind == quadrant::diagnosis::axis_kind::rotary);
    CHECK(axis.plant.gravity_torque_Nm.value_or(0) > 0);
    CHECK(axis.payload.mass_kg.value_or(0) == m.described[0].mechanics.payload.mass);
    CHECK(m.truth[0].mechanics.payload.mass != m.described[0].mechanics.payload.mass);
    CHECK(truth_of(m)["effects"][0]["parameters"].contains("payload.mass_kg"));
    const auto record = run(m.described, m.log_reference, m.period, m.noise_seed);
    std::istringstream text(log_file(m, record, m.noise_seed));
    CHECK_NOTHROW(check_match(machine, quadrant::diagnosis::read_log(text, "log.csv")));
    for (std::size_t k = 0; k < 20; ++k) CHECK(std::abs(record[0].position[k] - record[0].reference[k]) < 1e-3);
}
TEST_CASE("population: a seed draws the same machine by every compiler") { // written by g++, run by Clang, too
    const drawn_machine m = draw(20270107, 1, plan(20270107, 14).at(1));
    CHECK(m.effects.at(0).size == doctest::Approx(1.14059674).epsilon(1e-6));
}
