// SPDX-License-Identifier: BSL-1.0
// A spindle beside a drive whose log has few rows a turn (drive_simulator.hpp).
#include "position_drive.hpp"

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace quadrant::diagnosis;

TEST_CASE(
    "a process of nine rows a turn is named with its own frequency and its second harmonic, and with none "
    "that the rows do not hold") {
    constexpr double period = 2e-3, spindle_Hz = 54.6, first = 30, second = 12;
    const drive_simulator::machine described{.mass = 25,
                                             .viscous = 11,
                                             .gain = 4200,
                                             .integral = 90000,
                                             .position_gain = 25,
                                             .delay = period,
                                             .count = 2.5e-7};
    const nlohmann::json tolerance{{"mass", 0.02},          {"viscous", 0.2},
                                   {"velocity_gain", 0.01}, {"velocity_integral", 0.01},
                                   {"position_gain", 0.01}, {"command_delay", 0.05}};
    const auto milling = [&](double from) {
        auto m = described;
        for (std::size_t k = 0; k < 5000; ++k) {
            const double turn = 2 * std::numbers::pi * spindle_Hz * (from + static_cast<double>(k) * period);
            m.added.push_back(first * std::sin(turn) + second * std::sin(2 * turn + 1));
        }
        return m;
    };
    const auto d = position_drive::diagnosed(described, tolerance, period, milling(0), milling(0.7));
    REQUIRE(d.causes.size() == 1);
    CHECK(d.causes[0].effect == "cutting_force");
    CHECK(d.causes[0].probability >= 0.9);
    const auto& fundamental = d.causes[0].parameters.at(0).values;
    const auto& force = d.causes[0].parameters.at(1).values;
    CHECK(fundamental.at(0).value == doctest::Approx(spindle_Hz).epsilon(1e-3));
    CHECK(force.at(0).value == doctest::Approx(first).epsilon(0.1));
    CHECK(force.at(1).value == doctest::Approx(second).epsilon(0.3)); // held over four and a half rows a turn
    for (std::size_t i = 0; i < force.size(); ++i)
        CHECK_MESSAGE((force[i].value == 0 || static_cast<double>(i + 1) * spindle_Hz < 0.45 / period), i);
}
