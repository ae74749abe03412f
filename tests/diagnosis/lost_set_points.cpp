// SPDX-License-Identifier: BSL-1.0
// When the set-points of a position drive arrive, and whether they do (drive_simulator.hpp).
#include "claims.hpp"
#include "position_drive.hpp"
#include "shared.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/fit/for_machine.hpp>
#include <quadrant/diagnosis/fit/with_drives.hpp>

#include <algorithm>
#include <cmath>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 1e-3;
const drive_simulator::machine real{.mass = 20,
                                    .coulomb = 16,
                                    .viscous = 20,
                                    .gain = 20 * 2 * std::numbers::pi * 30,
                                    .position_gain = 40,
                                    .delay = 2e-3};

machine_description described(const drive_simulator::machine& m) {
    auto axis = position_drive::axis_of(m, period);
    axis["tolerance"] = {{"mass", 0.03},          {"viscous", 0.1},        {"coulomb", 0.08},
                         {"velocity_gain", 0.05}, {"position_gain", 0.03}, {"command_delay", 0.1}};
    if (m.integral > 0) axis["tolerance"]["velocity_integral"] = 0.05;
    return position_drive::file_of(axis, period);
}
machine_log recorded(const drive_simulator::machine& m, double pace = 1, unsigned seed = 1) {
    return position_drive::recorded(m, period, pace, seed);
}
diagnosis_result diagnosed(const machine_description& machine, const drive_simulator::machine& m) {
    return position_drive::diagnosed(machine, recorded(m), recorded(m, 0.8, 2));
}
} // namespace

TEST_CASE("set-point loss: the set-points that a drive lost are found, in its current and in its path") {
    auto m = real;
    m.lost = 0.06;
    SUBCASE("current") { m.force_of_current = 12; }
    SUBCASE("path") {
        if (!all_tests()) return;
    }
    SUBCASE("current, an integral in the velocity loop, a set-point every four rows") {
        if (!all_tests()) return;
        m.force_of_current = 12;
        m.integral = m.gain * 2 * std::numbers::pi * 6;
        m.rows_of_a_set_point = 4;
    }
    const auto d = diagnosed(described(m), m);
    CAPTURE(workshop::said(d));
    REQUIRE(workshop::claims(d) == std::vector<std::string>{"set_point_loss"});
    REQUIRE(d.causes.size() == 1);
    const cause& loss = d.causes[0];
    CHECK(workshop::value_of(loss, "drive.set_point_loss").value == doctest::Approx(0.06).epsilon(0.2));
    CHECK(loss.gap_after_force_rms_N.value < 0.4 * loss.gap_before_force_rms_N.value);
}

TEST_CASE("set-point loss: which ones were lost") {
    auto m = real;
    m.lost = 0.05;
    m.force_of_current = 12;
    const auto machine = described(m);
    const auto log = recorded(m);
    const axis_log driven = detail::with_drive(machine.axes[0], log.axes[0], period);
    const auto& axis = machine.axes[0];
    const auto record =
        for_machine(prepare(driven, period, m.count, scales_of(axis.plant, driven, period, m.count)), axis);
    plant_model plant(axis, record.scale.give());
    plant.drive.read = record.read;
    plant.drive.loss = 0.05;
    const auto received = record.observer.received(plant);
    REQUIRE(received->values.size() == log.axes[0].reference.size());
    const auto& sent = log.axes[0].reference;
    // The simulator's dice: a throw a set-point, but for the first.
    std::mt19937 dice(101);
    double moved = 0, lost = 0, found = 0, wrong = 0;
    for (std::size_t k = 1; k + 200 < sent.size(); ++k) {
        const bool gone = std::uniform_real_distribution()(dice) < m.lost;
        const double step = sent[k] - sent[k - 1];
        if (k < 200 || std::abs(step) < 2e-5) continue;
        const double share = (received->values[k] - sent[k]) / -step;
        moved += 1;
        lost += gone;
        found += gone && share > 0.5;
        wrong += !gone && share > 0.5;
    }
    REQUIRE(moved > 1000);
    REQUIRE(lost > 50);
    CHECK(found > 0.9 * lost);
    CHECK(wrong < 0.1 * lost);
    CHECK(received->choices > 0);
}

TEST_CASE("set-point loss: a drive that receives everything has lost nothing, where its gains are off too") {
    auto m = real;
    m.force_of_current = 12;
    auto off = m;
    off.gain *= 1.03;
    off.position_gain *= 0.98;
    off.delay *= 1.05;
    const auto d = diagnosed(described(off), m);
    CHECK(d.verdict <= verdict::within_tolerance);
    CHECK(d.causes.empty());
}

TEST_CASE("command delay: beyond its tolerance it is fitted to the end, and no friction stands for it" *
          doctest::test_suite("all")) {
    auto m = real;
    m.mass = 1500;
    m.coulomb = 200;
    m.viscous = 125;
    m.gain = m.mass * 2 * std::numbers::pi * 15;
    m.integral = m.gain * 2 * std::numbers::pi * 3;
    m.position_gain = 19;
    m.delay = 6e-3;
    m.count = 2e-6;
    auto off = m;
    off.delay = 4.95e-3;
    off.mass *= 0.985;
    const auto d = diagnosed(described(off), m);
    REQUIRE(!d.causes.empty());
    CHECK(d.causes[0].effect == "command_delay");
    CHECK(workshop::value_of(d.causes[0], "drive.command_delay_s").value ==
          doctest::Approx(6e-3).epsilon(0.02));
    CHECK(d.causes.size() == 1);
}
