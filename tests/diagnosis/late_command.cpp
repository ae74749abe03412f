// SPDX-License-Identifier: BSL-1.0
// A measured command that was recorded later than the motion that it makes.
#include "claims.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/fit/late_command.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace quadrant::diagnosis;

namespace {

constexpr double T = 0.001;
const plant_description plant = [] {
    plant_description p;
    p.mass_kg = 100;
    p.force_constant_N_per_V = 1.1;
    return p;
}();

/// Strokes of three frequencies, read in counts of 1 um.
struct motion {
    double x, v, a;
};
motion at(double t) {
    motion out{0, 0, 0};
    for (const auto& [size, frequency] :
         {std::pair{0.05, 0.7}, std::pair{0.004, 3.1}, std::pair{0.0008, 9.3}}) {
        const double w = 2 * std::numbers::pi * frequency;
        out.x += size * std::sin(w * t);
        out.v += size * w * std::cos(w * t);
        out.a -= size * w * w * std::sin(w * t);
    }
    return out;
}
/// command(t): what acts at that moment.
template <class Command> axis_log recorded(const Command& command, double white = 0.2) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, white);
    axis_log out;
    for (int k = 0; k < 8000; ++k) {
        const double t = k * T;
        out.position.push_back(1e-6 * std::round(1e6 * at(t).x));
        out.command.push_back(command(t) + noise(random));
    }
    out.position_step = 1e-6;
    return out;
}
double force(double t) {
    const motion m = at(t);
    return 90 * m.a + 300 * m.v + std::copysign(30.0, m.v);
}

/// As a drive writes its current: behind a first-order low-pass that runs once a row.
std::vector<double> behind_low_pass(std::vector<double> x, double kept) {
    for (std::size_t k = 1; k < x.size(); ++k) x[k] += kept * (x[k - 1] - x[k]);
    return x;
}
/// The machine file of a machine whose command is measured; its controller is not described.
machine_description with_measured_command(const workshop::machine& m) {
    auto file = workshop::described(m);
    file.axes[0].actuator.command_is = command_origin::measured;
    file.axes[0].controller.reset();
    return file;
}
/// What is said of a machine whose command `record` changed before it was logged; a note has these words.
template <class Record>
diagnosis_result diagnosed_as_recorded(const workshop::machine& real, const machine_description& file,
                                       const Record& record, const char* words) {
    auto log = workshop::as_log(workshop::run(real));
    record(log.axes[0].command);
    auto d = diagnose(file, log);
    CHECK(workshop::says(d, words));
    return d;
}

} // namespace

TEST_CASE("late command: one that was sent 2.3 rows after the position is read as much earlier, and one that "
          "was sent before it later, if it was measured") {
    // A row's command is its mean until the next row: read at the row it is half a row late already.
    const auto lateness = [](double rows, command_origin origin, double delay = 0) {
        plant_description described = plant;
        described.delay_s = delay * T;
        return lateness_of_command(recorded([&](double t) { return force(t - rows * T); }), T, described,
                                   origin) /
               T;
    };
    for (const auto origin : {command_origin::measured, command_origin::asked}) {
        CHECK(lateness(2.3, origin) == doctest::Approx(2.8).epsilon(0.02));
        CHECK(lateness(0, origin) == doctest::Approx(0.5).epsilon(0.02));
        CHECK(lateness(0, origin, 2) == doctest::Approx(2.5).epsilon(0.02));
        CHECK(lateness(-0.5, origin) == 0);
        CHECK(lateness(-2.5, origin, 2) == 0);
    }
    CHECK(lateness(-3, command_origin::measured) == doctest::Approx(-2.5).epsilon(0.02));
    CHECK(lateness(-3, command_origin::asked) == 0);    // a machine's delay
    CHECK(lateness(-1, command_origin::asked, 3) == 0); // one shorter than described
}
TEST_CASE(
    "late command: a machine whose command was recorded rows late has the causes that it has in time, and the "
    "report says so" *
    doctest::test_suite("all")) {
    const auto diagnosed_late = [](const workshop::machine& real, const machine_description& file, long rows) {
        return diagnosed_as_recorded(
            real, file, [&](auto& command) { workshop::stand_later(command, rows); }, "the command stands");
    };
    for (const double delay : {0.0, 0.0006}) { // read later than the motion, or than the described delay
        workshop::machine real;
        real.delay = delay;
        const auto file = with_measured_command(real);
        for (const long rows : {1, 3}) CHECK(diagnosed_late(real, file, rows).causes.empty());
        real.coulomb *= 1.3;
        workshop::named(diagnosed_late(real, file, 2), "coulomb_friction", "coulomb_N", real.coulomb, 0.1);
    }
}
TEST_CASE("late command: a low-pass is no delay of the same size, and is undone") {
    const axis_log in_time = recorded([](double t) { return force(t + 0.5 * T); });
    for (const double kept : {0.5, 0.7, 0.85}) {
        const double rows = kept / (1 - kept); // y + rows (y - what stood before) is what came in
        axis_log log = in_time;
        log.command = behind_low_pass(in_time.command, kept);
        const auto found = low_pass_of_command(log, T, plant);
        REQUIRE(found);
        CHECK(found->of_slope == doctest::Approx(rows * T).epsilon(0.1));
        CHECK(!low_pass_of_command(recorded([&](double t) { return force(t + (0.5 - rows) * T); }), T, plant));
    }
    CHECK(!low_pass_of_command(in_time, T, plant));
    // Noise of the current sensor, of half the friction, makes none of a delay.
    for (const double rows : {2.0, 8.0})
        CHECK(!low_pass_of_command(recorded([&](double t) { return force(t + (0.5 - rows) * T); }, 15), T,
                                   plant));
}
TEST_CASE("late command: a low-pass that runs all the time is undone, too") {
    const double tau = 3 * T;
    axis_log log = recorded(force);
    double filtered = force(0);
    constexpr int fine = 50;
    for (std::size_t k = 0; k < log.command.size(); ++k) {
        log.command[k] = filtered; // read at the row, in which the force of the row begins to act
        for (int i = 0; i < fine; ++i)
            filtered +=
                (force((static_cast<double>(k) + 0.5) * T) - filtered) * (1 - std::exp(-T / fine / tau));
    }
    const auto found = low_pass_of_command(log, T, plant);
    REQUIRE(found);
    CHECK(found->of_slope == doctest::Approx(tau + 0.5 * T).epsilon(0.1));
}
TEST_CASE("late command: beside missing rows a low-pass is not undone") {
    axis_log log = recorded(force);
    log.left_out.assign(log.command.size(), 0);
    log.left_out[100] = 1;
    const auto undone = read_before_low_pass(log, {.of_slope = 3 * T}, T);
    for (std::size_t k = 98; k <= 102; ++k) CHECK(undone.command[k] == log.command[k]);
    CHECK(undone.command[97] != log.command[97]);
    CHECK(undone.command[103] != log.command[103]);
}
TEST_CASE("late command: what a low-pass of the recorder took is put back") {
    axis_log log = recorded(force);
    log.command.clear();
    for (int k = 0; k < 2000; ++k) log.command.push_back(std::sin(0.1 * k));
    const auto before = log.command;
    log.command = behind_low_pass(before, 0.7);
    const auto after =
        read_before_low_pass(log, {.of_slope = 7.0 / 3 * T, .of_curvature = -3.5 / 3 * T * T}, T);
    for (std::size_t k = 100; k < 1900; ++k) CHECK(std::abs(after.command[k] - before[k]) < 0.01);
}
TEST_CASE("late command: a machine whose measured command stands behind a low-pass has the causes that it has "
          "without") {
    const auto diagnosed = [](const workshop::machine& real, const machine_description& file, double kept) {
        return diagnosed_as_recorded(
            real, file, [&](auto& command) { command = behind_low_pass(command, kept); },
            "as behind a low-pass");
    };
    workshop::machine real;
    const auto file = with_measured_command(real);
    for (const double kept : {0.65, 0.85}) CHECK(diagnosed(real, file, kept).causes.empty());
    real.coulomb *= 1.3;
    workshop::named(diagnosed(real, file, 0.65), "coulomb_friction", "coulomb_N", real.coulomb, 0.1);
}
TEST_CASE(
    "late command: no effect of the workshop's machines makes a command late by more than half a row, hides "
    "three rows, or makes a low-pass of them" *
    doctest::test_suite("all")) {
    workshop::machine as_described;
    as_described.delay = 0;
    const plant_description file = workshop::described(as_described).axes[0].plant;
    const auto late = [&](const std::function<void(workshop::machine&)>& change, long rows) {
        workshop::machine m = as_described;
        change(m);
        auto log = workshop::run(m);
        workshop::stand_later(log.command, rows);
        return log;
    };
    const auto lateness = [&](const std::function<void(workshop::machine&)>& change, long rows) {
        return lateness_of_command(late(change, rows), workshop::period, file, command_origin::measured) /
               workshop::period;
    };
    const auto low_pass = [&](const std::function<void(workshop::machine&)>& change, long rows) {
        return low_pass_of_command(late(change, rows), workshop::period, file).has_value();
    };
    const auto mode = [](double mass, double frequency, double damping) {
        return [=](workshop::machine& m) {
            m.mode_mass = mass, m.mass -= mass, m.mode_frequency = frequency, m.mode_damping = damping;
        };
    };
    for (const std::function<void(workshop::machine&)>& change :
         std::initializer_list<std::function<void(workshop::machine&)>>{
             mode(60, 40, 0.03), mode(60, 40, 0.3), mode(60, 90, 0.1), mode(90, 20, 0.05),
             [](auto& m) { m.cogging = 100; }, [](auto& m) { m.ripple = 0.1; }, [](auto& m) { m.cutting = 40; },
             [](auto& m) { m.excess = 60; }, [](auto& m) { m.bristle = 5e-5, m.coulomb = 150; },
             [](auto& m) { m.loss = 0.05; }}) {
        CHECK(lateness(change, 0) == 0);
        CHECK(std::abs(lateness(change, 3) - 3) < 0.5);
        for (const long rows : {0, 3}) CHECK(!low_pass(change, rows));
    }
    // A force that no regression knows, and larger than what three rows change: nothing is said.
    const auto spring = [](workshop::machine& m) { m.spring = 5e3; };
    for (const long rows : {0, 3}) CHECK((lateness(spring, rows) == 0 && !low_pass(spring, rows)));
}
TEST_CASE("late command: what a velocity loop answers is no force that moves the axis, however late") {
    const auto answer = [](double t) { return 40 - 500 * at(t - 3 * T).v; };
    CHECK(lateness_of_command(recorded(answer), T, plant, command_origin::measured) == 0);
    CHECK(!low_pass_of_command(recorded(answer), T, plant));
}
TEST_CASE("late command: a motion without acceleration, or a command of noise, says nothing") {
    std::mt19937 random(6);
    std::normal_distribution<double> noise(0, 5);
    CHECK(lateness_of_command(recorded([&](double) { return noise(random); }), T, plant,
                              command_origin::measured) == 0);
    CHECK(!low_pass_of_command(recorded([&](double) { return noise(random); }), T, plant));
    axis_log rest = recorded(force);
    std::fill(rest.position.begin(), rest.position.end(), 0.1);
    CHECK(lateness_of_command(rest, T, plant, command_origin::measured) == 0);
    CHECK(!low_pass_of_command(rest, T, plant));
}
TEST_CASE("late command: read earlier, a row has what stood later, and the end stays") {
    axis_log log;
    for (int k = 0; k < 10; ++k) log.command.push_back(k * k);
    const auto early = read_earlier(log, 2.5 * T, T);
    CHECK(early.command[0] == doctest::Approx(6.5));
    CHECK(early.command[6] == doctest::Approx(72.5));
    CHECK(early.command[9] == 81);
}
