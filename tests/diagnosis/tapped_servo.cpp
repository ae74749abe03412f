// SPDX-License-Identifier: BSL-1.0
// A hobby servo that tells its duty (drive_simulator.hpp): nobody knows when within a row it reads its
// registers, and that moment does to the duty what a gain does.
#include "drive_simulator.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <quadrant/diagnosis/fit/for_machine.hpp>
#include <quadrant/diagnosis/fit/with_drives.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/which/like_machines.hpp>
#include <sstream>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.02;
const drive_simulator::machine servo{
    .mass = 0.012, .coulomb = 0.002, .viscous = 0.2, .duty_gain = 11, .delay = 2e-3, .count = 3e-4};

machine_description file_of(const drive_simulator::machine& m) {
    const nlohmann::json q{{"plant",
                            {{"inertia_kg_m2", m.mass},
                             {"viscous_Nm_s_per_rad", m.viscous},
                             {"coulomb_Nm", m.coulomb},
                             {"torque_constant_Nm_per_V", m.kt}}},
                           {"tolerance",
                            {{"inertia", 0.05},
                             {"viscous", 0.15},
                             {"coulomb", 0.1},
                             {"torque_constant", 0.04},
                             {"position_gain", 0.05},
                             {"supply", 0.02},
                             {"command_delay", 0.0}}},
                           {"encoder", {{"resolution_rad", m.count}}},
                           {"drive",
                            {{"kind", "position_servo"},
                             {"position_gain_per_rad", m.duty_gain},
                             {"supply_V", m.supply},
                             {"command_delay_s", m.delay}}}};
    const nlohmann::json file{
        {"schema", "quadrant.machine/1"}, {"sample_period_s", period}, {"axes", {{"q", q}}}};
    return read_machine(file.dump(), "machine.json");
}
machine_log recorded(const drive_simulator::machine& m, double pace, unsigned seed) {
    std::istringstream text(
        drive_simulator::log(drive_simulator::takes::servo, m, period, pace, seed, "rad", true));
    return read_log(text, "log.csv");
}

} // namespace

TEST_CASE("like machines: behind a tap they differ by what no moment of reading takes off") {
    // Its damping makes it late, which is what a larger gain does, too.
    const auto machine = file_of(servo);
    const auto& axis = machine.axes[0];
    const auto log = with_drives(machine, recorded(servo, 1, 1));
    const auto scale = scales_of(axis.plant, log.axes[0], period, servo.count);
    const axis_record record =
        for_machine(prepare(log.axes[0], period, servo.count, scale), axis, held_by::loop, {});
    const plant_model described(axis, scale.give());
    const auto own = calibration(axis, scale.give());
    auto with_moments = own;
    for (parameter& p : numbers_of_record(described, record)) with_moments.push_back(std::move(p));
    REQUIRE(with_moments.size() == own.size() + 2);
    const auto fixed = cloud_of_like_machines(record, described, with_moments),
               fitted = cloud_of_fitted_machines(record, described, with_moments);
    bool taps = false;
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        if (!record.score.channels[i].of_tap) continue;
        taps = true;
        CHECK(fitted[i] < 0.5 * fixed[i]); // in energy
        CHECK(fitted[i] > 0);
    }
    CHECK(taps);
}
