// SPDX-License-Identifier: BSL-1.0
// A recorder that is slower than the controller: a row has one of several set-points.
#include "position_drive.hpp"

#include <doctest/doctest.h>
#include <numbers>
#include <quadrant/diagnosis/init.hpp>
#include <quadrant/diagnosis/model/driven_motion.hpp>

using namespace quadrant::diagnosis;

namespace {

/// Every n-th row of a log.
std::string every(std::size_t n, const std::string& log) {
    std::istringstream in(log);
    std::string out, line;
    std::getline(in, line);
    out = line + "\n";
    for (std::size_t k = 0; std::getline(in, line); ++k)
        if (k % n == 0) out += line + "\n";
    return out;
}
/// Of a controller at 1 kHz, recorded at 100 Hz.
machine_log slow(const drive_simulator::machine& m, double pace, unsigned seed) {
    std::istringstream text(
        every(10, drive_simulator::log(drive_simulator::takes::set_points, m, 1e-3, pace, seed, "m")));
    return read_log(text, "log.csv");
}
/// A P loop under a drive that takes positions. No loop of it is faster than a row of the slow log.
constexpr double gain = 20 * 2 * std::numbers::pi * 8;
drive_simulator::machine soft_drive() {
    return {.mass = 20,
            .coulomb = 16,
            .viscous = 20,
            .gain = gain,
            .position_gain = 10,
            .delay = 1e-3,
            .count = 1e-6};
}
nlohmann::json file_without_period() {
    auto axis = position_drive::axis_of(soft_drive(), 1e-3);
    axis["tolerance"] = {{"mass", 0.05},          {"viscous", 0.2},        {"coulomb", 0.1},
                         {"velocity_gain", 0.03}, {"position_gain", 0.03}, {"command_delay", 0.1}};
    axis["drive"].erase("set_point_period_s");
    return axis;
}
nlohmann::json file_with_period() {
    auto axis = file_without_period();
    axis["drive"]["set_point_period_s"] = 1e-3;
    return axis;
}
bool tells_of_the_rate(const diagnosis_result& d) {
    return std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("set-points in each row of the log") != note.npos;
    });
}

} // namespace

TEST_CASE("set-points between the rows lie on the curve through the rows, and a step is no curve") {
    constexpr double period = 0.01;
    constexpr std::size_t in_a_row = 10, rows = 200;
    const auto asked = [](double t) { return 0.01 * std::sin(2 * std::numbers::pi * 1.3 * t); };
    drive_model d;
    d.kind = drive_kind::position;
    d.velocity_gain = 1;
    d.position_gain = 1;
    driven_motion fast, slow_one;
    fast.period = period / in_a_row;
    slow_one.period = period;
    for (std::size_t k = 0; k < rows * in_a_row; ++k)
        fast.set_point.push_back(asked(static_cast<double>(k) * fast.period));
    for (std::size_t k = 0; k < rows; ++k) slow_one.set_point.push_back(fast.set_point[k * in_a_row]);
    for (driven_motion* m : {&fast, &slow_one}) {
        m->position.assign(m->set_point.size(), 0.0);
        m->find_velocity();
    }
    const auto each = fast.given(d);
    const auto most_beside = [&](double set_point_period) {
        d.set_point_period = set_point_period;
        const auto given = slow_one.given(d);
        double most = 0;
        for (std::size_t k = 2; k + 3 < rows; ++k) {
            double mean = 0;
            for (std::size_t i = 0; i < in_a_row; ++i) mean += each[k * in_a_row + i] / in_a_row;
            most = std::max(most, std::abs(given[k] - mean));
        }
        return most;
    };
    CHECK(most_beside(period / in_a_row) < 2e-6);
    CHECK(most_beside(period) > 3e-4); // held: half a row late

    driven_motion step = slow_one; // a copy remembers nothing
    std::fill(step.set_point.begin(), step.set_point.begin() + 100, 0.0);
    std::fill(step.set_point.begin() + 100, step.set_point.end(), 1.0);
    d.set_point_period = period / in_a_row;
    const auto stepped = step.given(d);
    CHECK(stepped[98] == 0);
    for (std::size_t k = 95; k < 105; ++k) CHECK((stepped[k] >= 0 && stepped[k] <= 1));
    CHECK(stepped[100] == doctest::Approx(1).epsilon(1e-12));
}
TEST_CASE("a log of every tenth set-point: a healthy drive has no cause beside the period in its file") {
    const auto found = position_drive::diagnosed(position_drive::file_of(file_with_period(), 0.01),
                                                 slow(soft_drive(), 1, 1), slow(soft_drive(), 0.8, 2));
    CHECK(found.verdict <= verdict::within_tolerance);
    CHECK(found.axes[0].gap.position_rms_m < 2e-6); // two counts
    CHECK(!tells_of_the_rate(found));
}
TEST_CASE("a log of every tenth set-point: a healthy drive has no cause beside a file without its period" *
          doctest::test_suite("all")) {
    const auto found = position_drive::diagnosed(position_drive::file_of(file_without_period(), 0.01),
                                                 slow(soft_drive(), 1, 1), slow(soft_drive(), 0.8, 2));
    CHECK(found.verdict <= verdict::within_tolerance);
    CHECK(found.causes.empty());
    CHECK(tells_of_the_rate(found));
}
TEST_CASE("a log of every tenth set-point: what is wrong with the axis is named beside them" *
          doctest::test_suite("all")) {
    auto heavy = soft_drive();
    heavy.mass *= 1.3;
    const auto log = slow(heavy, 1, 3), holdout = slow(heavy, 0.8, 4);
    for (const auto& file : {file_with_period(), file_without_period()}) {
        const auto found = position_drive::diagnosed(position_drive::file_of(file, 0.01), log, holdout);
        REQUIRE(!found.causes.empty());
        CHECK(found.causes[0].effect == "mass");
        CHECK(found.causes[0].probability >= 0.9);
        CHECK(found.causes[0].parameters.at(0).values.at(0).value == doctest::Approx(26).epsilon(0.05));
    }
}
TEST_CASE("init: of a log with every tenth set-point, the gains and set-points between the rows") {
    const auto log = slow(soft_drive(), 1, 1);
    init_request asked;
    asked.drive = drive_kind::position;
    asked.values["mass"][""] = 20;
    const auto begun = init_machine(asked, &log);
    const auto& axis = begun.machine["axes"]["q"];
    CHECK(axis["drive"]["set_point_period_s"] == 1e-3);
    CHECK(axis["drive"]["position_gain_per_s"].get<double>() == doctest::Approx(10).epsilon(0.03));
    CHECK(axis["drive"]["velocity_gain_N_s_per_m"].get<double>() == doctest::Approx(gain).epsilon(0.03));
    CHECK(axis["plant"]["coulomb_N"].get<double>() == doctest::Approx(16).epsilon(0.02));
    CHECK(std::any_of(begun.notes.begin(), begun.notes.end(), [](const std::string& note) {
        return note.find("the controller is faster than the log") != note.npos;
    }));
    asked.values["set-point-period"][""] = 0.01; // as the owner says
    const auto other = init_machine(asked, &log);
    CHECK(other.machine["axes"]["q"]["drive"]["set_point_period_s"] == 0.01);
}
TEST_CASE("a lighter mass behind a P loop answers as set-points between the rows do: it stays what is named" *
          doctest::test_suite("all")) {
    // 9 % of the mass; half a row of the loop's gain is as much.
    drive_simulator::machine described{.gain = 100 * 2 * std::numbers::pi * 30, .delay = 1e-3};
    described.coulomb = 30;
    described.viscous = 60;
    auto real = described;
    real.mass *= 0.91;
    const auto recorded = [&](double pace, unsigned seed) {
        std::istringstream text(
            drive_simulator::log(drive_simulator::takes::volts, real, 1e-3, pace, seed, "m"));
        return read_log(text, "log.csv");
    };
    nlohmann::json q;
    q["plant"] = {{"mass_kg", 100}, {"viscous_N_s_per_m", 60}, {"coulomb_N", 30}};
    q["tolerance"] = {{"mass", 0.03},          {"viscous", 0.2},    {"coulomb", 0.1},
                      {"velocity_gain", 0.01}, {"velocity", 0.002}, {"command_delay", 0.02}};
    q["encoder"] = {{"resolution_m", described.count}};
    q["drive"] = {{"kind", "velocity"},
                  {"command_delay_s", described.delay},
                  {"velocity_gain_N_s_per_m", described.gain},
                  {"velocity_per_V", described.velocity_per_V}};
    const auto found =
        position_drive::diagnosed(position_drive::file_of(q, 1e-3), recorded(1, 1), recorded(0.8, 2));
    REQUIRE(!found.causes.empty());
    CHECK(found.causes[0].effect == "mass");
    CHECK(claimed(found.causes[0]));
    CHECK(!tells_of_the_rate(found));
}
