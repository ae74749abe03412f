// SPDX-License-Identifier: BSL-1.0
// Units and signs of an imported log, checked by the physics of the axis.
#include "quadrant/diagnosis/check_physics.hpp"
#include "quadrant/diagnosis/import/physics.hpp"
#include "quadrant/diagnosis/read_log.hpp"
#include "refusal.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;
using workshop::near;

namespace {

/// A workshop log as an import has it.
imported_log of_workshop(double position_scale = 1, double command_scale = 1) {
    imported_log out;
    out.log = workshop::as_log(workshop::run({}, 6.2));
    for (double& y : out.log.axes[0].position) y *= position_scale;
    for (double& u : out.log.axes[0].command) u *= command_scale;
    return out;
}
} // namespace

TEST_CASE("import: a position in another unit than the reference is refused") {
    auto good = of_workshop();
    CHECK_NOTHROW(check_physics(good));
    auto bad = of_workshop(1000);
    CHECK(refusal_of([&] { check_physics(bad); }).find("moves 1e+03 times the distance of the reference") !=
          std::string::npos);
}

TEST_CASE("import: a velocity that is another than the position's is refused, a filtered one is not") {
    const auto with_velocity = [](double scale) {
        auto out = of_workshop();
        axis_log& a = out.log.axes[0];
        a.velocity = zero_phase(derivative(a.position, workshop::period), 40, workshop::period);
        for (double& v : a.velocity) v *= scale;
        return out;
    };
    auto good = with_velocity(0.9);
    CHECK_NOTHROW(check_physics(good));
    for (const double scale : {1000.0, 5.0, 0.2}) {
        auto bad = with_velocity(scale);
        CHECK(refusal_of([&] {
                  check_physics(bad);
              }).find("what the position makes of itself: x_vel_m_per_s") != std::string::npos);
    }
    auto turned = with_velocity(-1);
    CHECK(refusal_of([&] { check_physics(turned); }).find("the velocity goes against the position") !=
          std::string::npos);
}

TEST_CASE("import: a command that drives against the acceleration is refused, one of another size when the "
          "mass is known") {
    auto turned = of_workshop(1, -1);
    CHECK(refusal_of([&] { check_physics(turned); }).find("drives against the acceleration") !=
          std::string::npos);
    const workshop::machine m;
    auto right = of_workshop();
    CHECK_NOTHROW(check_physics(right, {m.mass, m.force_constant}));
    auto millivolts = of_workshop(1, 1000);
    CHECK_NOTHROW(check_physics(millivolts));
    CHECK(refusal_of([&] {
              check_physics(millivolts, {m.mass, m.force_constant});
          }).find("times the mass of 180") != std::string::npos);
    // The regression itself, against the machine's numbers.
    const auto c = check_units(right.log.axes[0], workshop::period);
    CHECK(near(c.command_per_acceleration, m.mass / m.force_constant, 0.1));
}

TEST_CASE("import: the units of a log are checked against its machine, and no other machine is refused") {
    const workshop::machine m;
    machine_description machine;
    machine.axes.emplace_back().name = "x";
    machine.axes[0].plant.mass_kg = m.mass;
    machine.axes[0].plant.force_constant_N_per_V = m.force_constant;
    const auto checked = [&](double position, double command, double reference = 0) {
        auto log = workshop::as_log(workshop::run({}, 6.2));
        for (double& y : log.axes[0].position) y *= position;
        for (double& r : log.axes[0].reference) r *= reference != 0 ? reference : position;
        for (double& u : log.axes[0].command) u *= command;
        return refusal_of([&] { check_physics(machine, log); });
    };
    CHECK(checked(1, 1) == "accepted");
    CHECK(checked(1, 2) == "accepted"); // a wrong force constant is for the diagnosis
    CHECK(checked(1000, 1).find("1/") != std::string::npos);
    CHECK(checked(1, 1000).find("mV in it make 1000 times") != std::string::npos);
    CHECK(checked(1, -1).find("the sign of x_pos_m or of x_cmd_V is turned") != std::string::npos);
    CHECK(checked(1, 1, 1000).find("the distance of the reference") != std::string::npos);
    CHECK(checked(1, 1, -1).find("moves against the reference") != std::string::npos);
}

TEST_CASE("import: a mass that the record shows poorly is no unit") {
    machine_description machine;
    machine.axes.emplace_back().name = "x";
    machine.axes[0].plant.mass_kg = 30; // and the record's mass is 1
    machine.axes[0].plant.force_constant_N_per_V = 1;
    const auto checked = [&](double other_force) {
        machine_log log;
        log.sample_period_s = 0.001;
        axis_log a;
        a.name = "x";
        std::mt19937 random(3);
        std::normal_distribution<double> noise;
        double slow = 0;
        for (int k = 0; k < 8000; ++k) {
            const double t = 0.001 * k, w = 12, w2 = 31;
            slow += 0.05 * (noise(random) - slow); // a force of the motion's own frequencies
            a.position.push_back(std::sin(w * t) / (w * w) + std::sin(w2 * t) / (w2 * w2));
            a.command.push_back(-std::sin(w * t) - std::sin(w2 * t) + other_force * slow);
        }
        a.reference = a.position;
        log.axes = {a};
        log.samples = a.position.size();
        return refusal_of([&] { check_physics(machine, log); });
    };
    const std::string alone = checked(0);
    CAPTURE(alone);
    CHECK(alone.find("the command moves 1/30 of the mass of 30") != std::string::npos);
    CHECK(checked(8) == "accepted"); // half of the command is another force: 1/30 may be 1/15
}

TEST_CASE("import: the set-point of a velocity drive is no force, and says nothing of the mass") {
    machine_description machine;
    machine.axes.emplace_back().name = "x";
    machine.axes[0].plant.mass_kg = 145;
    machine.axes[0].plant.force_constant_N_per_V = 1; // as a machine file that gives none is read
    const auto checked = [&](drive_kind drive, double command) {
        machine.axes[0].drive.kind = drive;
        machine_log log;
        log.sample_period_s = 0.001;
        axis_log a;
        a.name = "x";
        a.command_unit = "V";
        for (int k = 0; k < 8000; ++k) { // 0.64 V s^2/m lead the motion: a loop of 20 Hz behind 12 V s/m
            const double t = 0.001 * k, w = 12, w2 = 31;
            a.position.push_back(std::sin(w * t) / (w * w) + std::sin(w2 * t) / (w2 * w2));
            a.command.push_back(command * (12 * (std::cos(w * t) / w + std::cos(w2 * t) / w2) -
                                           0.64 * (std::sin(w * t) + std::sin(w2 * t))));
        }
        a.reference = a.position;
        log.axes = {a};
        log.samples = a.position.size();
        return refusal_of([&] { check_physics(machine, log); });
    };
    CHECK(checked(drive_kind::current, 1).find("of the mass of 145") != std::string::npos);
    CHECK(checked(drive_kind::velocity, 1) == "accepted");
    CHECK(checked(drive_kind::position, 1) == "accepted");
    CHECK(checked(drive_kind::velocity, -1).find("pushes against the motion") != std::string::npos);
}

namespace {

/// A slow axis with friction alone, read in coarse counts, or a fast one whose command is far earlier than the
/// reading: neither shows by its acceleration whether the command is turned.
std::string pushed(double sign, double friction, double inertia, double frequency, double lead) {
    std::vector<double> position, torque;
    for (int k = 0; k < 6000; ++k) {
        const double t = 0.01 * k, w = 2 * std::numbers::pi * frequency;
        const auto x = [&](double s) { return std::sin(w * s) + 0.4 * std::sin(2.3 * w * s + 1); };
        const double v = x(t + 1e-4) - x(t - 1e-4), e = t + lead;
        const double acceleration = (x(e + 1e-3) - 2 * x(e) + x(e - 1e-3)) / 1e-6;
        position.push_back(0.002 * std::round(x(t) / 0.002));
        torque.push_back(sign * (friction * (v > 0 ? 1 : -1) + inertia * acceleration + 3 +
                                 0.3 * std::sin(1.7 * k) + 0.1 * std::sin(0.0071 * k)));
    }
    imported_log in;
    in.log = workshop::torque_log(position, torque, 0.01, 0.002);
    return refusal_of([&] { check_physics(in); });
}
} // namespace

TEST_CASE(
    "import: a turned command is seen by the friction where the motion is too slow for the acceleration") {
    CHECK(pushed(1, 0.4, 0, 0.05, 0) == "accepted");
    CHECK(pushed(-1, 0.4, 0, 0.05, 0).find("the command pushes against the motion (-0.") != std::string::npos);
    CHECK(pushed(-1, 0.01, 0, 0.05, 0) == "accepted"); // too little to be sure of
    // Without friction, and with a command that leads the reading by 20 rows: what follows the speed is
    // negative there and makes three fifths of the command, and the jerk shows why.
    CHECK(pushed(1, 0, 0.02, 0.5, 0.2) == "accepted");
}
