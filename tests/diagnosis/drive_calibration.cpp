// SPDX-License-Identifier: BSL-1.0
// Calibration of machines whose drive closes loops of its own: delay and gains nearly stand for one another, so
// that the best numbers lie in a long narrow valley (drive_simulator.hpp).
#include "position_drive.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/fit/for_machine.hpp>
#include <quadrant/diagnosis/fit/with_drives.hpp>
#include <quadrant/diagnosis/which/calibration.hpp>

using namespace quadrant::diagnosis;

namespace {

/// The numbers of a position drive, or what they are off by.
struct numbers {
    double mass, viscous, coulomb, gain, integral, position_gain, delay;
};

drive_simulator::machine machine_of(const numbers& n, double count, int rows_of_a_set_point) {
    return {.mass = n.mass,
            .coulomb = n.coulomb,
            .viscous = n.viscous,
            .gain = n.gain,
            .integral = n.integral,
            .position_gain = n.position_gain,
            .delay = n.delay,
            .count = count,
            .rows_of_a_set_point = rows_of_a_set_point};
}
numbers off_by(const numbers& n, const numbers& ratio) {
    return {n.mass * ratio.mass,  n.viscous * ratio.viscous,   n.coulomb * ratio.coulomb,
            n.gain * ratio.gain,  n.integral * ratio.integral, n.position_gain * ratio.position_gain,
            n.delay * ratio.delay};
}
machine_description file_of(const numbers& n, const numbers& tolerance, double count, int rows_of_a_set_point) {
    auto axis = position_drive::axis_of(machine_of(n, count, rows_of_a_set_point), 1e-3);
    axis["tolerance"] = {{"mass", tolerance.mass},
                         {"viscous", tolerance.viscous},
                         {"coulomb", tolerance.coulomb},
                         {"velocity_gain", tolerance.gain},
                         {"velocity_integral", tolerance.integral},
                         {"position_gain", tolerance.position_gain},
                         {"command_delay", tolerance.delay}};
    return position_drive::file_of(axis, 1e-3);
}
machine_log log_of(const drive_simulator::machine& m, double pace, unsigned seed) {
    return position_drive::recorded(m, 1e-3, pace, seed);
}
void not_blamed(const machine_description& machine, const machine_log& log, const machine_log& holdout) {
    const auto d = position_drive::diagnosed(machine, log, holdout);
    CHECK(d.verdict <= verdict::within_tolerance);
    for (const cause& c : d.causes) CHECK_MESSAGE(c.group_probability < 0.5, c.effect);
}
const numbers described{100, 60, 30, 25132.741, 1263309.4, 40, 1e-3},
    tolerance{0.05, 0.2, 0.1, 0.03, 0.05, 0.03, 0.1}, ratio{0.976, 0.963, 0.98, 1.0234, 0.9665, 1.0269, 1.0898};
constexpr double count = 5e-8;

} // namespace

TEST_CASE(
    "position drive: calibration ends no worse from the described numbers than from those that the machine "
    "has") {
    const auto machine = file_of(described, tolerance, count, 1);
    const auto log = with_drives(machine, log_of(machine_of(off_by(described, ratio), count, 1), 1, 3));
    const auto& axis = machine.axes[0];
    const auto scale = scales_of(axis.plant, log.axes[0], 1e-3, count);
    const axis_record record = for_machine(prepare(log.axes[0], 1e-3, count, scale), axis);
    const plant_model given(axis, scale.give());
    auto from_file = calibration(axis, scale.give());
    for (parameter& p : numbers_of_record(given, record)) from_file.push_back(std::move(p));
    auto from_truth = from_file;
    for (const auto& [key, by] : {std::pair{"mass_kg", ratio.mass},
                                  {"viscous_N_s_per_m", ratio.viscous},
                                  {"coulomb_N", ratio.coulomb},
                                  {"drive.velocity_gain_N_s_per_m", ratio.gain},
                                  {"drive.velocity_integral_N_per_m", ratio.integral},
                                  {"drive.position_gain_per_s", ratio.position_gain},
                                  {"drive.command_delay_s", ratio.delay}})
        for (parameter& p : from_truth)
            if (p.key == key) p.start *= by;
    const fitter fit(record.observer, record.score);
    // As many steps as a search takes; less than the margin of one more cause decides nothing.
    CHECK(fit.fit(given, from_file, 30).objective < fit.fit(given, from_truth, 30).objective + rules().margin);
}
TEST_CASE(
    "position drive: a machine inside its tolerances whose fit goes along the whole valley is not blamed for a "
    "friction that stops it" *
    doctest::test_suite("all")) {
    const auto machine = file_of(described, tolerance, count, 1);
    const auto m = machine_of(off_by(described, ratio), count, 1);
    const machine_log log = log_of(m, 1, 3), holdout = log_of(m, 0.8, 4);
    not_blamed(machine, log, holdout);
}
TEST_CASE(
    "position drive whose set-points come three periods late, where the file excludes the delay: neither more "
    "than half of them are said to be lost, nor clocks to slip by nothing" *
    doctest::test_suite("all")) {
    auto late = machine_of(described, 1e-6, 1);
    late.delay += 3e-3;
    auto machine = file_of(described, tolerance, 1e-6, 1);
    machine.excluded_effects = {"command_delay"};
    const machine_log log = log_of(late, 1, 1), holdout = log_of(late, 0.8, 2);
    const auto d = position_drive::diagnosed(machine, log, holdout);
    CHECK(d.verdict > verdict::within_tolerance);
    const auto check = [&](const std::vector<parameter_estimate>& found) {
        for (const auto& p : found) {
            if (p.key == "drive.set_point_loss") CHECK(p.values[0].value <= 0.5);
            // Ten thousand set-points: a slip of a third of one over all of them is a delay.
            if (p.key == "drive.clock_slip") CHECK(std::abs(p.values[0].value) * 10000 > 0.29);
        }
    };
    for (const cause& c : d.causes) {
        check(c.parameters);
        for (const auto& r : c.readings) check(r.parameters);
    }
}
TEST_CASE(
    "calibration beside a measured current: gains and limit of the drive's force move by the force constant's "
    "tolerance, too, and nothing else does") {
    auto machine = file_of(described, tolerance, 1e-6, 1);
    auto& axis = machine.axes[0];
    axis.command_unit = "A";
    axis.plant.force_constant_N_per_V = 20;
    axis.drive.force_limit_N = 75;
    axis.tolerance.given["force_constant"] = 0.08;
    const auto alone = calibration(axis, 1e-6), joint = calibration(axis, 1e-6, true);
    CHECK(joint.size() == alone.size() + 1);
    for (const parameter& p : joint) {
        CAPTURE(p.key);
        if (p.key == "drive.force_limit_N") {
            CHECK(p.low == doctest::Approx(0.92 * 75));
            CHECK(p.high == doctest::Approx(1.08 * 75));
            continue;
        }
        const auto before =
            std::find_if(alone.begin(), alone.end(), [&](const auto& q) { return q.key == p.key; });
        REQUIRE(before != alone.end());
        const bool force =
            p.key == "drive.velocity_gain_N_s_per_m" || p.key == "drive.velocity_integral_N_per_m";
        CHECK(p.high == doctest::Approx((force ? 1.08 : 1) * before->high));
    }
}
TEST_CASE("position drive with a measured current: a force constant inside its tolerance moves the gains "
          "as the "
          "current shows them, and nobody is blamed" *
          doctest::test_suite("all")) {
    constexpr double constant = 20; // [N/A]
    auto m = machine_of(off_by(described, {1.02, 1.1, 1.04, 1.01, 0.98, 1.005, 1.03}), 1e-6, 1);
    auto machine = file_of(described, tolerance, 1e-6, 1);
    auto& axis = machine.axes[0];
    axis.command_unit = "A";
    axis.plant.force_constant_N_per_V = constant;
    axis.tolerance.given["force_constant"] = 0.08;
    for (const double off : {-0.07, 0.07}) {
        CAPTURE(off);
        m.force_of_current = constant * (1 + off);
        const machine_log log = log_of(m, 1, 5), holdout = log_of(m, 0.8, 6);
        not_blamed(machine, log, holdout);
    }
}
