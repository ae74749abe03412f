// SPDX-License-Identifier: BSL-1.0
// Position drives on the clock of their master: a set-point comes just as the current is read
// (drive_simulator.hpp).
#include "drive_simulator.hpp"

#include <algorithm>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.002, constant = 50; // [s], [N/A]
const drive_simulator::machine drive{.mass = 120,
                                     .coulomb = 60,
                                     .viscous = 200,
                                     .gain = 25000,
                                     .position_gain = 35,
                                     .delay = period,
                                     .force_of_current = constant,
                                     .velocity_feedforward = 1};

/// The file of this drive with another mass and another delay of the set-points.
std::string file_with(double mass, double delay) {
    const drive_simulator::machine& m = drive;
    nlohmann::json q;
    q["plant"] = {{"mass_kg", mass},
                  {"viscous_N_s_per_m", m.viscous},
                  {"coulomb_N", m.coulomb},
                  {"force_constant_N_per_A", constant}};
    q["tolerance"] = {{"mass", 0.05},           {"viscous", 0.1},        {"coulomb", 0.05},
                      {"force_constant", 0.02}, {"velocity_gain", 0.05}, {"position_gain", 0.03},
                      {"command_delay", 0.1}};
    q["encoder"] = {{"resolution_m", m.count}};
    q["drive"] = {{"kind", "position"},
                  {"interpolation", "linear"},
                  {"velocity_feedforward", m.velocity_feedforward},
                  {"velocity_gain_N_s_per_m", m.gain},
                  {"position_gain_per_s", m.position_gain},
                  {"command_delay_s", delay},
                  {"set_point_period_s", period}};
    return nlohmann::json{{"schema", "quadrant.machine/1"}, {"sample_period_s", period}, {"axes", {{"q", q}}}}
        .dump();
}
diagnosis_result diagnosed(const drive_simulator::machine& m, const std::string& file) {
    const auto read = [&](double pace, unsigned seed) {
        std::istringstream text(
            drive_simulator::log(drive_simulator::takes::set_points, m, period, pace, seed, "m"));
        return read_log(text, "log.csv");
    };
    const machine_log log = read(1, 1), holdout = read(0.8, 2);
    rules one;
    one.threads = 1;
    return diagnose(
        read_machine(file, "machine.json"), log, &holdout, [](const std::string&) {}, one);
}

} // namespace

TEST_CASE(
    "position drive whose current is read as its set-point comes: a mass that is 40 % off is named, not taken "
    "for a delay that is 3 % off") {
    auto heavy = drive;
    heavy.mass *= 1.4;
    for (const bool before : {true, false}) {
        CAPTURE(before);
        heavy.current_before = before;
        const auto found = diagnosed(heavy, file_with(drive.mass, 1.03 * period));
        REQUIRE(found.causes.size() == 1);
        CHECK(found.causes[0].effect == "mass");
        CHECK(found.causes[0].probability > 0.9);
        CHECK(found.causes[0].parameters[0].values[0].value == doctest::Approx(heavy.mass).epsilon(0.03));
    }
}

TEST_CASE("position drive whose current is read as its set-point comes: nobody is blamed for a delay that is 3 "
          "% off" *
          doctest::test_suite("all")) {
    for (const bool before : {true, false}) {
        CAPTURE(before);
        auto as_described = drive;
        as_described.current_before = before;
        const auto found = diagnosed(as_described, file_with(drive.mass, 1.03 * period));
        CHECK(found.causes.empty());
        CHECK(found.verdict <= verdict::within_tolerance);
    }
}
