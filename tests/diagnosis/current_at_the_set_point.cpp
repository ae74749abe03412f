// SPDX-License-Identifier: BSL-1.0
// Position drives on the clock of their master: a set-point comes just as the current is read
// (drive_simulator.hpp).
#include "position_drive.hpp"

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.002; // [s]
const drive_simulator::machine drive{.mass = 120,
                                     .coulomb = 60,
                                     .viscous = 200,
                                     .gain = 25000,
                                     .position_gain = 35,
                                     .delay = period,
                                     .force_of_current = 50,
                                     .velocity_feedforward = 1};

/// What is found of a machine beside the file of `drive` with a delay that is 3 % off.
diagnosis_result diagnosed(const drive_simulator::machine& m) {
    auto described = drive;
    described.delay *= 1.03;
    const nlohmann::json tolerance{{"mass", 0.05},           {"viscous", 0.1},        {"coulomb", 0.05},
                                   {"force_constant", 0.02}, {"velocity_gain", 0.05}, {"position_gain", 0.03},
                                   {"command_delay", 0.1}};
    return position_drive::diagnosed(described, tolerance, period, m, m);
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
        const auto found = diagnosed(heavy);
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
        const auto found = diagnosed(as_described);
        CHECK(found.causes.empty());
        CHECK(found.verdict <= verdict::within_tolerance);
    }
}
