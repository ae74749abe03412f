// SPDX-License-Identifier: BSL-1.0
// What `init` says of a drive with loops of its own from a log, on machines of a simulator that shares nothing
// with the library (drive_simulator.hpp), and on the records of a real servo.
#include "drive_simulator.hpp"
#include "quadrant/diagnosis/init.hpp"
#include "quadrant/diagnosis/read_log.hpp"
#include "quadrant/diagnosis/read_machine.hpp"
#include "refusal.hpp"
#include "shared.hpp"

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;
using drive_simulator::takes;

namespace {

constexpr double bandwidth = 2 * std::numbers::pi * 40; // of the velocity loop [rad/s]
const drive_simulator::machine p_drive{.coulomb = 30, .viscous = 60, .gain = 100 * bandwidth, .delay = 1e-3};
const drive_simulator::machine pi_drive = [] {
    auto m = p_drive;
    m.integral = m.gain * 2 * std::numbers::pi * 8;
    return m;
}();
drive_simulator::machine position(drive_simulator::machine m) {
    m.position_gain = 40;
    return m;
}
const drive_simulator::machine servo{
    .mass = 0.004, .coulomb = 0.03, .viscous = 0.01, .duty_gain = 20, .delay = 2e-3, .count = 1e-4};

machine_log recorded(takes kind, const drive_simulator::machine& m, bool tap = false) {
    const bool rotary = kind == takes::servo;
    std::istringstream text(
        drive_simulator::log(kind, m, rotary ? 0.002 : 0.001, 1, 1, rotary ? "rad" : "m", tap));
    return read_log(text, "log.csv");
}
init_request asked(drive_kind kind, std::map<std::string, double> values) {
    init_request r;
    r.drive = kind;
    for (const auto& [option, value] : values) r.values[option][""] = value;
    return r;
}
std::string refusal(const init_request& r, const machine_log* log) {
    return refusal_of([&] { init_machine(r, log); });
}

/// What init writes under a key of the axis; and the 95 % interval that its comments state.
struct stated {
    double value, low, high;
    bool holds(double truth) const { return low <= truth && truth <= high; }
};
stated number(const initialised_machine& m, const char* box, const std::string& key) {
    const auto& axis = m.machine["axes"]["q"];
    REQUIRE_MESSAGE(axis[box].contains(key), key);
    const auto row = m.comments.find(fmt::format("`axes.q.{}.{}`", box, key));
    const std::string words = "95 % interval ";
    const auto at = m.comments.find(words, row);
    REQUIRE(at != std::string::npos);
    stated out{axis[box][key], 0, 0};
    REQUIRE(std::sscanf(m.comments.c_str() + at + words.size(), "%lf to %lf", &out.low, &out.high) == 2);
    return out;
}

} // namespace

TEST_CASE("init: the loops of a velocity drive come from the log, each within its interval" *
          doctest::test_suite("all")) {
    for (const auto& m : {pi_drive, p_drive}) {
        if (m.integral == 0 && !all_tests()) continue;
        const auto log = recorded(takes::volts, m);
        const auto begun = init_machine(asked(drive_kind::velocity, {{"mass", 100}}), &log);
        CHECK(number(begun, "drive", "velocity_per_V").holds(m.velocity_per_V));
        CHECK(number(begun, "drive", "velocity_gain_N_s_per_m").holds(m.gain));
        CHECK(number(begun, "drive", "command_delay_s").holds(m.delay));
        CHECK(begun.machine["axes"]["q"]["drive"].contains("velocity_integral_N_per_m") == (m.integral > 0));
        if (m.integral > 0) CHECK(number(begun, "drive", "velocity_integral_N_per_m").holds(m.integral));
        const stated friction = number(begun, "plant", "coulomb_N");
        CHECK(friction.value == doctest::Approx(m.coulomb).epsilon(0.02));
        // The interval is the tolerance, and what is written can be read.
        const auto axis = read_machine(begun.machine.dump(), "m.json").axes.at(0);
        CHECK(axis.tolerance.of("velocity_gain") < 0.1);
    }
}
TEST_CASE("init: the loops of a position drive come from the log, each within its interval" *
          doctest::test_suite("all")) {
    for (const auto& m : {position(p_drive), position(pi_drive)}) {
        const auto log = recorded(takes::set_points, m);
        const auto begun = init_machine(asked(drive_kind::position, {{"mass", 100}}), &log);
        CHECK(number(begun, "drive", "position_gain_per_s").holds(m.position_gain));
        CHECK(number(begun, "drive", "velocity_gain_N_s_per_m").holds(m.gain));
        CHECK(number(begun, "drive", "command_delay_s").holds(m.delay));
        CHECK(begun.machine["axes"]["q"]["drive"]["interpolation"] == "linear");
        CHECK(begun.machine["axes"]["q"]["drive"].contains("velocity_integral_N_per_m") == (m.integral > 0));
        CHECK(number(begun, "plant", "coulomb_N").value == doctest::Approx(m.coulomb).epsilon(0.02));
    }
}
TEST_CASE("init: the gain of a servo comes from its duty, its torque constant from the path" *
          doctest::test_suite("all")) {
    for (const bool tap : {true, false}) {
        const auto log = recorded(takes::servo, servo, tap);
        auto r = asked(drive_kind::position_servo, {{"mass", 0.004}, {"supply", 12}});
        if (!tap) {
            CHECK(refusal(r, &log).find("--servo-gain or --torque-constant is missing") != std::string::npos);
            r.values["servo-gain"][""] = 20;
        }
        const auto begun = init_machine(r, &log);
        if (tap) CHECK(number(begun, "drive", "position_gain_per_rad").holds(servo.duty_gain));
        CHECK(number(begun, "plant", "torque_constant_Nm_per_V").holds(servo.kt));
        CHECK(number(begun, "plant", "viscous_Nm_s_per_rad").holds(servo.viscous));
        CHECK(number(begun, "plant", "coulomb_Nm").holds(servo.coulomb));
        CHECK(number(begun, "drive", "command_delay_s").holds(servo.delay));
    }
}
TEST_CASE("init: with a measured current the force constant of a drive is per ampere") {
    auto m = position(p_drive);
    m.force_of_current = 20;
    const auto log = recorded(takes::set_points, m);
    const auto begun = init_machine(asked(drive_kind::position, {{"mass", 100}, {"force-constant", 20}}), &log);
    CHECK(begun.machine["axes"]["q"]["plant"]["force_constant_N_per_A"] == 20);
    CHECK(number(begun, "drive", "position_gain_per_s").holds(m.position_gain));
}
TEST_CASE("init: a drive whose numbers nothing fixes is refused with what is missing") {
    const auto volts = recorded(takes::volts, p_drive), goals = recorded(takes::servo, servo, true);
    CHECK(refusal(asked(drive_kind::velocity, {}), &volts) ==
          "init: axis q: --mass is missing: the motion shows the gains of a drive only relative to the mass");
    CHECK(refusal(asked(drive_kind::velocity, {{"mass", 100}, {"force-constant", 20}}), &volts) ==
          "init: axis q: --force-constant is newtons per ampere of a measured current, and the log has none: "
          "leave it out");
    CHECK(refusal(asked(drive_kind::position_servo, {{"mass", 0.004}}), &goals) ==
          "init: axis q: --supply is missing (the volts of a duty of 1)");
    CHECK(refusal(asked(drive_kind::position_servo, {{"supply", 12}}), &goals)
              .find("axis q: --inertia, --torque-constant or --gravity-torque is missing") !=
          std::string::npos);
    CHECK(refusal(asked(drive_kind::velocity, {{"mass", 100}}), &goals).find("q_cmd_rad_per_s is missing") !=
          std::string::npos);
    CHECK(refusal(asked(drive_kind::position, {{"mass", 100}, {"supply", 12}}), &volts)
              .find("supply_V: belongs to a drive of kind position_servo; this one is position") !=
          std::string::npos);
    auto against = volts;
    for (double& u : against.axes[0].command) u = -u;
    CHECK(refusal(asked(drive_kind::velocity, {{"mass", 100}}), &against)
              .find("the velocity runs against the command") != std::string::npos);
}
TEST_CASE("init: a loop faster than the record can show is said, not guessed" * doctest::test_suite("all")) {
    auto fast = p_drive;
    fast.gain = 100 * 2 * std::numbers::pi * 2000; // answers in a twelfth of a row
    fast.coulomb = 0;
    const auto log = recorded(takes::volts, fast);
    const std::string said = refusal(asked(drive_kind::velocity, {{"mass", 100}}), &log);
    CHECK(said.find("the log does not show P of the drive's velocity loop") != std::string::npos);
    CHECK(said.find("give --drive-velocity-gain") != std::string::npos);
}
TEST_CASE("init: a command of the wrong sign is named, not written without an inertia") {
    // A free inertia, its torque logged with the wrong sign.
    std::ostringstream text;
    text << "t_s,q_ref_rad,q_pos_rad,q_cmd_Nm\n";
    for (int k = 0; k < 6000; ++k) {
        const double t = 0.001 * k, w = 2 * std::numbers::pi;
        const double q = 0.5 * std::sin(w * t) + 0.05 * std::sin(7 * w * t),
                     a = -0.5 * w * w * std::sin(w * t) - 0.05 * 49 * w * w * std::sin(7 * w * t);
        text << t << ',' << q << ',' << std::round(q * 1e5) / 1e5 << ',' << -0.02 * a << '\n';
    }
    std::istringstream in(text.str());
    const auto log = read_log(in, "log.csv");
    init_request r;
    r.from_log = true;
    CHECK(refusal(r, &log) == "init: axis q: --inertia is missing; in the log the axis accelerates against its "
                              "command: check the sign of one of the two");
}
TEST_CASE(
    "init: a real servo, its gain to two per cent, its inertia and torque constant as its makers of models "
    "found them" *
    doctest::test_suite("all") * doctest::skip(shared_missing())) {
    // shared/data/servo_pendulum: 0.0028774 duty a rad for each unit of kp; 0.0078 kg m2; 0.123 N m/V, which
    // fits of single motions miss by 10 to 15 %.
    for (const int kp : {100, 200, 400}) {
        CAPTURE(kp);
        const auto log =
            read_log(shared_data() / fmt::format("data/servo_pendulum/records/sin_time_square_kp{}.csv", kp));
        const auto begun = init_machine(
            asked(drive_kind::position_servo, {{"gravity-torque", 0.4805}, {"supply", 7.4}}), &log);
        CHECK(number(begun, "drive", "position_gain_per_rad").value ==
              doctest::Approx(0.0028774 * kp).epsilon(0.02));
        CHECK(number(begun, "plant", "inertia_kg_m2").value == doctest::Approx(0.0078).epsilon(0.1));
        CHECK(number(begun, "plant", "torque_constant_Nm_per_V").value == doctest::Approx(0.123).epsilon(0.15));
    }
}
