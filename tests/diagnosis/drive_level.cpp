// SPDX-License-Identifier: BSL-1.0
// The force limit of a drive whose integral is replayed: it acts at the level that the motion needs, not where
// a gain that is a little wrong takes the integral (drive_simulator.hpp).
#include "drive_simulator.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/fit/with_drives.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

using namespace quadrant::diagnosis;

namespace {

constexpr double bandwidth = 2 * std::numbers::pi * 30; // of the velocity loop [rad/s]
const drive_simulator::machine axis{.mass = 20,
                                    .coulomb = 8,
                                    .viscous = 20,
                                    .gain = 20 * bandwidth,
                                    .integral = 20 * bandwidth * 40,
                                    .position_gain = 40,
                                    .delay = 1e-3};

machine_log recorded(const drive_simulator::machine& m, double period, double pace = 1, unsigned seed = 1) {
    std::istringstream text(
        drive_simulator::log(drive_simulator::takes::set_points, m, period, pace, seed, "m"));
    return read_log(text, "log.csv");
}
machine_description described(double position_gain, double force_limit, double period) {
    return read_machine(std::string_view(fmt::format(
                            R"({{"schema": "quadrant.machine/1", "sample_period_s": {}, "axes": {{"q": {{
        "plant": {{"mass_kg": 20, "viscous_N_s_per_m": 20, "coulomb_N": 8}},
        "tolerance": {{"mass": 0.03, "viscous": 0.15, "coulomb": 0.08, "velocity_gain": 0.05,
                       "velocity_integral": 0.05, "position_gain": 0.03, "command_delay": 0.3}},
        "encoder": {{"resolution_m": 1e-6}},
        "drive": {{"kind": "position", "command_delay_s": 0.001, "velocity_gain_N_s_per_m": {},
                   "velocity_integral_N_per_m": {}, "position_gain_per_s": {}, "force_limit_N": {},
                   "interpolation": "linear"}}}}}}}})",
                            period, axis.gain, axis.integral, position_gain, force_limit)),
                        "machine.json");
}
/// What this drive makes of the log: force of the actuator, mean of each row [N].
std::vector<double> replayed(const machine_description& machine, const machine_log& log, double limit) {
    const axis_description& a = machine.axes[0];
    drive_model d(a.drive);
    d.force_limit = limit;
    return detail::with_drive(a, log.axes[0], machine.sample_period_s).drive->given(d);
}
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double out = 0;
    for (std::size_t k = 0; k < a.size(); ++k) out = std::max(out, std::abs(a[k] - b[k]));
    return out;
}
double largest(const std::vector<double>& a) { return largest_difference(a, std::vector<double>(a.size(), 0)); }
diagnosis_result diagnosed(const machine_description& machine, const machine_log& log,
                           const machine_log* holdout = nullptr) {
    rules one;
    one.threads = 1;
    return diagnose(
        machine, log, holdout, [](const std::string&) {}, one);
}

} // namespace

TEST_CASE(
    "replay: a gain that is off by its tolerance takes the integral past any limit, and no limit acts that "
    "did not act on the machine") {
    constexpr double period = 1e-3, limit = 150;
    const auto log = recorded(axis, period);
    const auto machine = described(40 * 1.03, limit, period);
    const auto free = replayed(machine, log, drive_model::none), held = replayed(machine, log, limit);
    CHECK(largest(free) > 2 * limit); // in an open loop
    CHECK(largest_difference(free, held) < 1e-9 * limit);
}

TEST_CASE(
    "replay: a limit that acts on the machine as described is no gap, and without it in the file it is one" *
    doctest::test_suite("all")) {
    constexpr double period = 1e-3, limit = 45;
    auto m = axis;
    m.force_limit = limit;
    const auto log = recorded(m, period);
    const auto right = diagnosed(described(40, limit, period), log);
    CHECK(right.verdict <= verdict::within_tolerance);
    CHECK(right.causes.empty());
    const auto wrong = diagnosed(described(40, 3 * limit, period), log);
    REQUIRE(!wrong.causes.empty());
    CHECK(wrong.causes.front().effect == "drive_limit");
    CHECK(wrong.causes.front().probability >= 0.9);
    CHECK(wrong.causes.front().parameters.front().values.front().value == doctest::Approx(limit).epsilon(0.05));
}

TEST_CASE("replay: under a limit that is too low for the motion the level does not run off") {
    constexpr double period = 1e-3, limit = 45;
    const auto log = recorded(axis, period);
    CHECK(largest(replayed(described(40, 1000, period), log, limit)) < 3 * limit);
}

TEST_CASE("position drive: another gain of the position loop is found beside a described limit" *
          doctest::test_suite("all")) {
    constexpr double period = 2e-3;
    const auto d = diagnosed(described(62, 120, period), recorded(axis, period));
    REQUIRE(!d.causes.empty());
    CHECK(d.causes.front().effect == "drive_gain");
    CHECK(d.causes.front().probability >= 0.9);
    CHECK(d.causes.front().parameters.front().key == "drive.position_gain_per_s");
    CHECK(d.causes.front().parameters.front().values.front().value == doctest::Approx(40).epsilon(0.05));
}

TEST_CASE("position drive: where its velocity loop answers between two rows its path is judged, and a healthy "
          "axis is blamed for nothing" *
          doctest::test_suite("all")) {
    constexpr double period = 1e-2;
    const auto log = recorded(axis, period, 0.6), holdout = recorded(axis, period, 0.5, 2);
    for (const machine_log* beside : {static_cast<const machine_log*>(nullptr), &holdout}) {
        const auto d = diagnosed(described(40, 1000, period), log, beside);
        CHECK(d.verdict <= verdict::within_tolerance);
        CHECK(d.causes.empty());
    }
    const auto slower = diagnosed(described(62, 1000, period), log, &holdout);
    REQUIRE(!slower.causes.empty());
    CHECK(slower.causes.front().effect == "drive_gain");
    CHECK(slower.causes.front().parameters.front().values.front().value == doctest::Approx(40).epsilon(0.05));
}
