// SPDX-License-Identifier: BSL-1.0
// A drive whose velocity loop stands at its limit, while no column shows what it gives (drive_simulator.hpp).
#include "drive_simulator.hpp"

#include <doctest/doctest.h>
#include <numbers>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

using namespace quadrant::diagnosis;

TEST_CASE("velocity drive: a limit is found where its law, whose integral winds up, asks for a multiple of it" *
          doctest::test_suite("all")) {
    constexpr double bandwidth = 2 * std::numbers::pi * 40; // of the velocity loop [rad/s]
    const drive_simulator::machine limited{.coulomb = 30,
                                           .viscous = 60,
                                           .gain = 100 * bandwidth,
                                           .integral = 100 * bandwidth * 2 * std::numbers::pi * 8,
                                           .delay = 1e-3,
                                           .force_limit = 60};
    const auto machine = read_machine(std::string_view(R"({"schema": "quadrant.machine/1",
        "sample_period_s": 0.001, "axes": {"q": {
        "plant": {"mass_kg": 100, "viscous_N_s_per_m": 60, "coulomb_N": 30},
        "tolerance": {"mass": 0.05, "viscous": 0.2, "coulomb": 0.1, "velocity_gain": 0.03,
                      "velocity_integral": 0.05, "velocity": 0.005, "command_delay": 0.1},
        "encoder": {"resolution_m": 1e-6},
        "drive": {"kind": "velocity", "command_delay_s": 0.001, "velocity_per_V": 0.02,
                  "velocity_gain_N_s_per_m": 25132.741, "velocity_integral_N_per_m": 1263309.4}}}})"),
                                      "machine.json");
    const auto recorded = [&](double pace, unsigned seed) {
        std::istringstream text(
            drive_simulator::log(drive_simulator::takes::volts, limited, 1e-3, pace, seed, "m"));
        return read_log(text, "log.csv");
    };
    const machine_log log = recorded(1, 1), holdout = recorded(0.8, 2);
    rules one;
    one.threads = 1;
    const auto d = diagnose(
        machine, log, &holdout, [](const std::string&) {}, one);
    REQUIRE(!d.causes.empty());
    const cause& c = d.causes.front();
    CAPTURE(std::string(name_of(d.verdict)));
    CHECK(c.effect == "drive_limit");
    CHECK(c.probability >= 0.5);
    for (const cause& other : d.causes)
        if (&other != &c) CHECK_MESSAGE(other.group_probability < 0.5, other.effect);
    CHECK(c.parameters.front().values.front().value == doctest::Approx(limited.force_limit).epsilon(0.03));
}
