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
template <class Command> axis_log recorded(const Command& command) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 0.2);
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

} // namespace

TEST_CASE(
    "late command: one that was sent 2.3 rows after the position is read as much earlier, one in time is not") {
    // A row's command is its mean until the next row: read at the row it is half a row late already.
    const double late = lateness_of_command(recorded([](double t) { return force(t - 2.3 * T); }), T);
    CHECK(late / T == doctest::Approx(2.8).epsilon(0.05));
    CHECK(lateness_of_command(recorded(force), T) == 0);
    CHECK(lateness_of_command(recorded([](double t) { return force(t + 0.5 * T); }), T) == 0);
    CHECK(lateness_of_command(recorded([](double t) { return force(t + 3 * T); }), T) ==
          0); // a machine's delay
}
TEST_CASE("late command: a healthy machine whose command was recorded two rows late has no cause, and the "
          "report says so") {
    workshop::machine real;
    real.delay = 0; // a current makes its force at once
    auto file = workshop::described(real);
    auto& axis = file.axes[0];
    axis.actuator.command_is = command_origin::measured;
    axis.controller.reset();
    auto log = workshop::as_log(workshop::run(real));
    auto& u = log.axes[0].command;
    std::rotate(u.begin(), u.end() - 2, u.end());
    u[0] = u[1] = u[2];
    const auto d = diagnose(file, log);
    CHECK(d.causes.empty());
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("the measured command stands") != std::string::npos;
    }));
}
TEST_CASE("late command: what a velocity loop answers is no force that moves the axis, however late") {
    const auto answer = [](double t) { return 40 - 500 * at(t - 3 * T).v; };
    CHECK(lateness_of_command(recorded(answer), T) == 0);
}
TEST_CASE("late command: a motion without acceleration, or a command of noise, says nothing") {
    std::mt19937 random(6);
    std::normal_distribution<double> noise(0, 5);
    CHECK(lateness_of_command(recorded([&](double) { return noise(random); }), T) == 0);
    axis_log rest = recorded(force);
    std::fill(rest.position.begin(), rest.position.end(), 0.1);
    CHECK(lateness_of_command(rest, T) == 0);
}
TEST_CASE("late command: read earlier, a row has what stood later, and the end stays") {
    axis_log log;
    for (int k = 0; k < 10; ++k) log.command.push_back(k * k);
    const auto early = read_earlier(log, 2.5 * T, T);
    CHECK(early.command[0] == doctest::Approx(6.5));
    CHECK(early.command[6] == doctest::Approx(72.5));
    CHECK(early.command[9] == 81);
}
