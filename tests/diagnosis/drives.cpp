// SPDX-License-Identifier: BSL-1.0
// Long: one simulator of a drive and its records, and the findings of each kind of drive.
// Machines whose drive closes loops of its own, from a simulator that shares nothing with the library
// (drive_simulator.hpp), through the diagnosis.
#include "drive_simulator.hpp"
#include "quadrant_gap/make_match.hpp"
#include "shared.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/compensate.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/fit/with_drives.hpp>
#include <quadrant/diagnosis/forecast.hpp>
#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/model/as_reading.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>
#include <quadrant/diagnosis/write_machine.hpp>
#include <random>

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
const drive_simulator::machine servo{
    .mass = 0.004, .coulomb = 0.03, .viscous = 0.01, .duty_gain = 20, .delay = 2e-3, .count = 1e-4};

std::string linear(const std::string& plant, const std::string& drive) {
    return R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"q": {
        "plant": {"mass_kg": 100, "viscous_N_s_per_m": 60)" +
           plant + R"(},
        "tolerance": {"mass": 0.05, "viscous": 0.2, "coulomb": 0.1, "velocity_gain": 0.03, "velocity_integral": 0.05,
                      "velocity": 0.005, "position_gain": 0.03, "command_delay": 0.1},
        "encoder": {"resolution_m": 1e-6}, "drive": {"command_delay_s": 0.001, )" +
           drive + "}}}}";
}
const std::string coulomb = R"(, "coulomb_N": 30)";
const std::string of_p = R"("kind": "velocity", "velocity_gain_N_s_per_m": 25132.741, "velocity_per_V": 0.02)";
const std::string of_pi = of_p + R"(, "velocity_integral_N_per_m": 1263309.4)";
const std::string of_position = R"("kind": "position", "velocity_gain_N_s_per_m": 25132.741,
    "velocity_integral_N_per_m": 1263309.4, "position_gain_per_s": 40, "interpolation": "linear")";
const std::string of_servo = R"({"schema": "quadrant.machine/1", "sample_period_s": 0.004, "axes": {"q": {
    "plant": {"inertia_kg_m2": 0.004, "viscous_Nm_s_per_rad": 0.01, "coulomb_Nm": 0.03,
              "torque_constant_Nm_per_V": 0.1},
    "tolerance": {"inertia": 0.05, "viscous": 0.2, "coulomb": 0.1, "torque_constant": 0.05, "position_gain": 0.03,
                  "supply": 0.02, "command_delay": 0.2},
    "encoder": {"resolution_rad": 1e-4},
    "drive": {"kind": "position_servo", "position_gain_per_rad": 20, "supply_V": 12, "command_delay_s": 0.002}}}})";

struct records {
    machine_log log, holdout;
};
records recorded(takes kind, const drive_simulator::machine& m, bool tap = false) {
    const double period = kind == takes::servo ? 0.004 : 0.001;
    const std::string unit = kind == takes::servo ? "rad" : "m";
    const auto read = [&](double pace, unsigned seed) {
        std::istringstream text(drive_simulator::log(kind, m, period, pace, seed, unit, tap));
        return read_log(text, "log.csv");
    };
    return {read(1, 1), read(0.8, 2)};
}
diagnosis_result diagnosed(const std::string& file, const records& r) {
    const auto machine = read_machine(file, "machine.json");
    check_match(machine, r.log);
    rules one;
    one.threads = 1;
    return diagnose(
        machine, r.log, &r.holdout, [](const std::string&) {}, one);
}
bool blames_nobody(const diagnosis_result& d) {
    return d.verdict <= verdict::within_tolerance &&
           std::none_of(d.causes.begin(), d.causes.end(),
                        [](const cause& c) { return c.group_probability >= 0.5; });
}
/// The first cause, alone and claimed; null: not so.
const cause* only_claim(const diagnosis_result& d, const std::string& effect) {
    const auto claims = std::count_if(d.causes.begin(), d.causes.end(),
                                      [](const cause& c) { return c.group_probability >= 0.5; });
    if (claims != 1 || d.causes[0].effect != effect || d.causes[0].probability < 0.5) return nullptr;
    return &d.causes[0];
}
double value_of(const cause& c, const std::string& key) {
    for (const auto& p : c.parameters)
        if (p.key == key) return p.values[0].value;
    return 0;
}

} // namespace

TEST_CASE("velocity drive, P: nobody is blamed on a healthy machine" * doctest::test_suite("all")) {
    CHECK(blames_nobody(diagnosed(linear(coulomb, of_p), recorded(takes::volts, p_drive))));
}
TEST_CASE("velocity drive, PI: nobody is blamed on a healthy machine") {
    CHECK(blames_nobody(diagnosed(linear(coulomb, of_pi), recorded(takes::volts, pi_drive))));
}
TEST_CASE("velocity drive, PI: the friction that its integral hides is found within 10 %, and the mass is not "
          "blamed") {
    const auto d = diagnosed(linear("", of_pi), recorded(takes::volts, pi_drive));
    const cause* friction = only_claim(d, "coulomb_friction");
    REQUIRE(friction);
    CHECK(value_of(*friction, "coulomb_N") == doctest::Approx(30).epsilon(0.1));
}
TEST_CASE(
    "velocity drive with a measured current: every number of the file is wrong by most of its tolerance, and "
    "nobody is blamed, whichever way the current is read" *
    doctest::test_suite("all")) {
    auto m = pi_drive;
    m.force_of_current = 20;
    m.mass = 103;
    m.delay = 1.08e-3;
    m.gain *= 1.02;
    m.integral *= 0.97;
    for (const bool mean : {false, true}) {
        m.current_is_mean = mean;
        const auto d =
            diagnosed(linear(coulomb + R"(, "force_constant_N_per_A": 20)", of_pi), recorded(takes::volts, m));
        CHECK(blames_nobody(d));
        const auto found = [&](const std::string& key) {
            for (const auto& p : d.axes[0].calibrated)
                if (p.key == key) return p.values[0].value;
            return 0.0;
        };
        CHECK(found("mass_kg") / found("force_constant_N_per_V") ==
              doctest::Approx(m.mass / m.force_of_current).epsilon(0.005));
        CHECK(found("drive.velocity_gain_N_s_per_m") == doctest::Approx(m.gain).epsilon(0.01));
        CHECK(found("drive.command_delay_s") == doctest::Approx(m.delay).epsilon(0.02));
    }
}
TEST_CASE(
    "velocity drive with a measured current: the noise of the position does not decide how the current is "
    "read, where the set-points arrive within a row" *
    doctest::test_suite("all")) {
    auto m = pi_drive;
    m.force_of_current = 20;
    m.delay = 7.5e-4;
    std::string file = linear(coulomb + R"(, "force_constant_N_per_A": 20)", of_pi);
    const std::string described = R"("command_delay_s": 0.001)";
    file.replace(file.find(described), described.size(), R"("command_delay_s": 0.0007)");
    for (const bool mean : {false, true}) {
        m.current_is_mean = mean;
        const auto d = diagnosed(file, recorded(takes::volts, m));
        CHECK(blames_nobody(d));
        const auto ratio = [&] { // of mass and force constant; a mean in place of a moment moves it by 6 %
            double mass = 100, constant = 20;
            for (const auto& p : d.axes[0].calibrated) {
                if (p.key == "mass_kg") mass = p.values[0].value;
                if (p.key == "force_constant_N_per_V") constant = p.values[0].value;
            }
            return mass / constant;
        };
        CHECK(ratio() == doctest::Approx(5).epsilon(0.01));
    }
}
TEST_CASE("velocity drive with a measured current: what the tolerances of its gains excuse is no gap" *
          doctest::test_suite("all")) {
    auto m = pi_drive;
    m.force_of_current = 20;
    records r = recorded(takes::volts, m);
    for (machine_log* log : {&r.log, &r.holdout}) // the sensor's gain wanders by one per cent
        for (std::size_t k = 0; k < log->axes[0].effort.size(); ++k)
            log->axes[0].effort[k] *=
                1 + 0.01 * std::sin(2 * std::numbers::pi * 0.0007 * static_cast<double>(k));
    const auto d = diagnosed(linear(coulomb + R"(, "force_constant_N_per_A": 20)", of_pi), r);
    CHECK(d.verdict == verdict::within_tolerance);
    CHECK(blames_nobody(d));
}
TEST_CASE("velocity drive with a measured current: its delay and a limit inside it are found" *
          doctest::test_suite("all")) {
    auto late = pi_drive, limited = pi_drive;
    late.force_of_current = limited.force_of_current = 20;
    late.current_is_mean = limited.current_is_mean = true;
    late.delay = 2e-3;
    limited.force_limit = 60;
    const std::string file = linear(coulomb + R"(, "force_constant_N_per_A": 20)", of_pi);
    const auto of_late = diagnosed(file, recorded(takes::volts, late));
    const cause* delay = only_claim(of_late, "command_delay");
    REQUIRE(delay);
    CHECK(value_of(*delay, "drive.command_delay_s") == doctest::Approx(late.delay).epsilon(0.02));
    const auto of_limited = diagnosed(file, recorded(takes::volts, limited));
    const cause* limit = only_claim(of_limited, "drive_limit");
    REQUIRE(limit);
    CHECK(value_of(*limit, "drive.force_limit_N") == doctest::Approx(limited.force_limit).epsilon(0.03));
}
TEST_CASE("velocity drive with a measured current: a limit below the described one is a claim" *
          doctest::test_suite("all")) {
    // Without friction the simulator's current has no noise: read as the row begins, it stands at the limit.
    auto limited = pi_drive;
    limited.coulomb = 0;
    limited.force_of_current = 20;
    limited.force_limit = 60;
    const std::string file = linear(R"(, "force_constant_N_per_A": 20)", of_pi + R"(, "force_limit_N": 900)");
    const auto d = diagnosed(file, recorded(takes::volts, limited));
    const cause* limit = only_claim(d, "drive_limit");
    REQUIRE(limit);
    CHECK(value_of(*limit, "drive.force_limit_N") == doctest::Approx(limited.force_limit).epsilon(0.03));
}
TEST_CASE("position drive with a measured current: nothing is said of a command that was measured") {
    auto m = pi_drive;
    m.position_gain = 40;
    m.force_of_current = 20;
    auto r = recorded(takes::set_points, m);
    REQUIRE(r.log.axes[0].command_is == command_origin::measured);
    const auto machine =
        read_machine(linear(coulomb + R"(, "force_constant_N_per_A": 20)", of_position), "machine.json");
    quadrant_gap::make_match(machine, r.log, &r.holdout);
    for (const std::string& note : r.log.notes) CHECK(note.find("command_is") == note.npos);
}
TEST_CASE("as_reading: from the force that a wrong reading makes of a drive's law comes that reading") {
    const double period = 1e-3;
    drive_model d;
    d.velocity_gain = 300;
    d.velocity_integral = 9000;
    d.position_gain = 40;
    std::mt19937 random(3);
    std::normal_distribution<double> noise;
    for (const drive_kind kind : {drive_kind::velocity, drive_kind::position}) {
        d.kind = kind;
        std::vector<double> wrong(2000), force;
        double before = 0, sum = 0;
        for (double& y : wrong) {
            y = noise(random);
            // What the velocity loop takes for its error.
            const double e = (y - before) / period + (kind == drive_kind::position ? d.position_gain * y : 0);
            sum += e * period;
            force.push_back(d.velocity_gain * e + d.velocity_integral * sum);
            before = y;
        }
        const auto found = as_reading(d, force, period, 1);
        for (std::size_t k = 0; k < wrong.size(); ++k)
            REQUIRE(found[k] == doctest::Approx(wrong[k]).epsilon(1e-6).scale(1));
    }
}
TEST_CASE("velocity drive: another gain of the drive is the drive's" * doctest::test_suite("all")) {
    auto m = p_drive;
    m.gain *= 0.6;
    const auto d = diagnosed(linear(coulomb, of_p), recorded(takes::volts, m));
    const cause* gain = only_claim(d, "drive_gain");
    REQUIRE(gain);
    CHECK(value_of(*gain, "drive.velocity_gain_N_s_per_m") == doctest::Approx(m.gain).epsilon(0.05));
    CHECK(d.axes[0].where[0].block == "drive");
}
TEST_CASE("write_machine: a drive of each kind is written as it was read") {
    const std::string all = R"(, "velocity_filter_Hz": 300, "force_limit_N": 900)";
    const std::string of_steps =
        R"(, "set_point_period_s": 0.002, "velocity_feedforward": 0.9, "set_point_loss": 0.01)";
    for (const std::string& text :
         {linear("", of_pi + all), linear("", of_position + all + of_steps), of_servo}) {
        const auto asked = nlohmann::json::parse(text)["axes"]["q"]["drive"];
        const auto written = to_json(read_machine(text, "m.json"))["axes"]["q"]["drive"];
        CHECK(nlohmann::json::parse(written.dump()) == asked);
    }
}
TEST_CASE("velocity drive: set-points that come late are the drive's delay" * doctest::test_suite("all")) {
    auto m = pi_drive;
    m.delay = 4e-3;
    const cause* delay = nullptr;
    const auto d = diagnosed(linear(coulomb, of_pi), recorded(takes::volts, m));
    REQUIRE((delay = only_claim(d, "command_delay")));
    CHECK(value_of(*delay, "drive.command_delay_s") == doctest::Approx(4e-3).epsilon(0.1));
}
TEST_CASE("velocity drive: one that measures its velocity late has no set-points that come early" *
          doctest::test_suite("all")) {
    auto m = pi_drive;
    m.mass = 120;
    m.velocity_filter = 0.3e-3;
    const auto d = diagnosed(linear(coulomb, of_pi), recorded(takes::volts, m));
    INFO(name_of(d.verdict));
    REQUIRE(!d.causes.empty());
    CHECK(d.causes[0].effect == "mass");
    CHECK(d.causes[0].probability > 0.9);
    for (const cause& c : d.causes) {
        CAPTURE(c.probability);
        if (c.effect != "mass") CHECK(c.group_probability < 0.5);
    }
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("may as well be a velocity that the drive measures as much late") != note.npos;
    }));
}
TEST_CASE("position drive: the friction that its loops hide is found, from the reference alone" *
          doctest::test_suite("all")) {
    auto m = p_drive;
    m.position_gain = 40;
    const std::string of_p_position =
        R"("kind": "position", "velocity_gain_N_s_per_m": 25132.741, "position_gain_per_s": 40, "interpolation": "linear")";
    const auto d = diagnosed(linear("", of_p_position), recorded(takes::set_points, m));
    const cause* friction = only_claim(d, "coulomb_friction");
    REQUIRE(friction);
    CHECK(value_of(*friction, "coulomb_N") == doctest::Approx(30).epsilon(0.1));
}
TEST_CASE("position drive with an integral: the friction is the only cause, within 5 %" *
          doctest::test_suite("all")) {
    auto m = pi_drive;
    m.position_gain = 40;
    const auto d = diagnosed(linear("", of_position), recorded(takes::set_points, m));
    const cause* friction = only_claim(d, "coulomb_friction");
    REQUIRE(friction);
    CHECK(d.verdict == verdict::explained);
    CHECK(value_of(*friction, "coulomb_N") == doctest::Approx(30).epsilon(0.05));
}
TEST_CASE("position drive: nobody is blamed on a healthy machine" * doctest::test_suite("all")) {
    auto m = pi_drive;
    m.position_gain = 40;
    CHECK(blames_nobody(diagnosed(linear(coulomb, of_position), recorded(takes::set_points, m))));
}
TEST_CASE(
    "position drive: a machine anywhere inside its tolerances is blamed for nothing, although delay and gains "
    "nearly stand for one another" *
    doctest::test_suite("all")) {
    auto file = linear(coulomb, of_position);
    file.replace(file.find("1e-6"), 4, "5e-8");
    for (const double side : {-1, 1}) {
        auto m = pi_drive;
        m.count = 5e-8;
        m.position_gain = 40 * (1 + 0.01 * side);
        m.gain *= 1 - 0.01 * side;
        m.integral *= 1 + 0.02 * side;
        m.delay *= 1 - 0.05 * side;
        m.mass *= 1 + 0.02 * side;
        m.viscous *= 1 - 0.15 * side;
        CAPTURE(side);
        CHECK(blames_nobody(diagnosed(file, recorded(takes::set_points, m))));
    }
}
TEST_CASE("position drive with an integral: a process force is found without a mean, which the integral hides" *
          doctest::test_suite("all")) {
    auto m = pi_drive;
    m.position_gain = 40;
    m.count = 5e-8;
    for (int k = 0; k < 10000; ++k) m.added.push_back(5 * std::sin(2 * std::numbers::pi * 21 * 1e-3 * k));
    auto file = linear(coulomb, of_position);
    file.replace(file.find("1e-6"), 4, "5e-8");
    const auto d = diagnosed(file, recorded(takes::set_points, m));
    const cause* process = only_claim(d, "cutting_force");
    REQUIRE(process);
    CHECK(d.verdict == verdict::explained);
    CHECK(value_of(*process, "process.force_N") == doctest::Approx(5).epsilon(0.05));
    CHECK(value_of(*process, "process.mean_N") == 0);
}
TEST_CASE("velocity drive behind LinuxCNC's pid: with the values to type the following error falls as "
          "forecast, to 15 %" *
          doctest::test_suite("all")) {
    for (auto m : {p_drive, pi_drive}) {
        m.stock_pid = true;
        auto file = nlohmann::json::parse(linear("", m.integral > 0 ? of_pi : of_p));
        file["axes"]["q"]["controller"] = {
            {"kind", "linuxcnc_pid"}, {"Pgain", 1000}, {"maxoutput", 10}, {"error-previous-target", false}};
        const auto before = recorded(takes::volts, m);
        const auto machine = read_machine(file.dump(), "machine.json");
        const auto d = diagnosed(file.dump(), before);
        const auto found = compensate(machine, d, before.log, 0.5).axes.at(0);
        const compensation* best = &found.compensations.at(0); // the others add a force, or a dead band
        REQUIRE(best->claimed);
        for (const key_value& k : best->keys) (k.key == "FF1" ? m.ff1 : m.ff2) = k.values[0];
        CHECK(m.ff1 == doctest::Approx(50).epsilon(0.02)); // 0.02 m/s a volt
        CHECK(m.ff2 > 0);
        const auto after = recorded(takes::volts, m).log.axes[0];
        double square = 0, peak = 0;
        for (std::size_t k = 0; k < after.position.size(); ++k) {
            const double e = after.reference[k] - after.position[k];
            square += e * e;
            peak = std::max(peak, std::abs(e));
        }
        const double rms = std::sqrt(square / static_cast<double>(after.position.size()));
        CHECK(rms < 0.5 * found.measured.rms_m.value); // it asks for more than 10 V at times
        CHECK(best->after.rms_m.value == doctest::Approx(rms).epsilon(0.15).scale(0));
        CHECK(best->after.peak_m.value == doctest::Approx(peak).epsilon(0.15).scale(0));
    }
}
/// What a forecast says of the hold-out log's motion from its reference alone, and what simulate finds on that
/// log.
void check_forecast(const std::string& file, const records& r, const std::string& effect) {
    const auto machine = read_machine(file, "machine.json");
    rules one;
    one.threads = 1;
    const auto d = diagnose(
        machine, r.log, nullptr, [](const std::string&) {}, one);
    REQUIRE(only_claim(d, effect));
    machine_log planned = r.holdout;
    planned.axes[0].position.assign(planned.samples, 0.0);
    planned.axes[0].command.clear();
    const auto expected = forecast(machine, d, planned).axes.at(0);
    const double before = simulate(machine, r.holdout).axes[0].gap.force_rms_N,
                 after = simulate(apply(machine, d, 0.5), r.holdout).axes[0].gap.force_rms_N;
    CHECK(expected.before.force_rms_N == doctest::Approx(before).epsilon(0.15));
    CHECK(std::abs(expected.shrink - (1 - after / before)) < 0.1);
}
TEST_CASE(
    "forecast: behind a drive of each kind the gap shrinks on another motion as forecast from its reference" *
    doctest::test_suite("all")) {
    auto file = nlohmann::json::parse(linear("", of_p));
    auto m = p_drive;
    m.stock_pid = true;
    file["axes"]["q"]["controller"] = {
        {"kind", "linuxcnc_pid"}, {"Pgain", 1000}, {"maxoutput", 10}, {"error-previous-target", false}};
    check_forecast(file.dump(), recorded(takes::volts, m), "coulomb_friction");
    auto position = pi_drive;
    position.position_gain = 40;
    check_forecast(linear("", of_position), recorded(takes::set_points, position), "coulomb_friction");
    auto described = nlohmann::json::parse(of_servo);
    described["axes"]["q"]["plant"].erase("coulomb_Nm");
    check_forecast(described.dump(), recorded(takes::servo, servo, true), "coulomb_friction");
}
TEST_CASE("forecast: a velocity drive without a described controller has none, with a note") {
    const auto r = recorded(takes::volts, p_drive);
    diagnosis_result found;
    found.axes.emplace_back().name = "q";
    const auto f = forecast(read_machine(linear(coulomb, of_p), "machine.json"), found, r.holdout);
    CHECK(f.axes.empty());
    REQUIRE(f.notes.size() == 1);
    CHECK(f.notes[0].find("without a controller") != std::string::npos);
}
TEST_CASE("velocity drive: one that switches itself off for half a second is found, with the times" *
          doctest::test_suite("all")) {
    auto m = p_drive;
    m.off_from = 4.3;
    m.off_until = 4.8;
    auto r = recorded(takes::volts, m);
    r.holdout = recorded(takes::volts, p_drive).holdout; // it happened in the log only
    const auto d = diagnosed(linear(coulomb, of_p), r);
    const cause* dropout = only_claim(d, "drive_dropout");
    REQUIRE(dropout);
    CHECK(value_of(*dropout, "off_from_s") == doctest::Approx(4.3).epsilon(0.005));
    CHECK(value_of(*dropout, "off_until_s") == doctest::Approx(4.8).epsilon(0.005));
}
TEST_CASE("velocity drive: where a column says that it was off, nobody is blamed" *
          doctest::test_suite("all")) {
    auto m = pi_drive;
    m.off_from = 4.3;
    m.off_until = 4.8;
    m.enabled_column = true;
    CHECK(blames_nobody(diagnosed(linear(coulomb, of_pi), recorded(takes::volts, m))));
}
TEST_CASE("position drive: a clock that runs 100 ppm slow is found" * doctest::test_suite("all")) {
    auto m = p_drive;
    m.position_gain = 40;
    m.clock_slip = 1e-4;
    const std::string held =
        R"("kind": "position", "velocity_gain_N_s_per_m": 25132.741, "position_gain_per_s": 40, "interpolation": "linear")";
    const auto d = diagnosed(linear(coulomb, held), recorded(takes::set_points, m));
    const cause* slip = only_claim(d, "clock_slip");
    REQUIRE(slip);
    CHECK(value_of(*slip, "drive.clock_slip") == doctest::Approx(1e-4).epsilon(0.1));
}
TEST_CASE("position servo: nobody is blamed on a healthy machine, with a measured duty or without") {
    CHECK(blames_nobody(diagnosed(of_servo, recorded(takes::servo, servo, true))));
    if (all_tests()) CHECK(blames_nobody(diagnosed(of_servo, recorded(takes::servo, servo))));
}
TEST_CASE(
    "position servo: a measured duty tells the servo's gain from its torque; without it they are one group" *
    doctest::test_suite("all")) {
    auto m = servo;
    m.duty_gain = 12;
    const auto tapped = diagnosed(of_servo, recorded(takes::servo, m, true));
    const cause* gain = only_claim(tapped, "drive_gain");
    REQUIRE(gain);
    CHECK(value_of(*gain, "drive.position_gain_per_rad") == doctest::Approx(12).epsilon(0.05));
    if (!all_tests()) return;
    const auto bare = diagnosed(of_servo, recorded(takes::servo, m));
    REQUIRE(!bare.causes.empty());
    CHECK(bare.causes[0].group_probability >= 0.5);
    std::vector<std::string> names = bare.causes[0].confusable_with;
    names.push_back(bare.causes[0].effect);
    std::sort(names.begin(), names.end());
    CHECK(names == std::vector<std::string>{"drive_gain", "force_constant", "supply_voltage"});
}
TEST_CASE("position drive: a constant force that no model has began in the integral of both logs, and takes "
          "nothing from "
          "a cause" *
          doctest::test_suite("all")) {
    auto m = pi_drive;
    m.position_gain = 40;
    m.constant = -90;
    auto file = nlohmann::json::parse(linear(coulomb, of_position));
    for (const char* gain : {"velocity_gain", "velocity_integral", "position_gain"})
        file["axes"]["q"]["tolerance"][gain] = 0.01;
    CHECK(blames_nobody(diagnosed(file.dump(), recorded(takes::set_points, m))));
    m.viscous = 400;
    const cause* viscous = nullptr;
    const auto d = diagnosed(file.dump(), recorded(takes::set_points, m));
    REQUIRE((viscous = only_claim(d, "viscous_friction")));
    CHECK(viscous->probability >= 0.9);
    CHECK(value_of(*viscous, "viscous_N_s_per_m") == doctest::Approx(400).epsilon(0.1));
}
TEST_CASE("position servo: another gain shows in the measured duty, where the path is one that the tolerances "
          "allow" *
          doctest::test_suite("all")) {
    auto m = servo;
    m.duty_gain = 18.4;
    const cause* gain = nullptr;
    const auto d = diagnosed(of_servo, recorded(takes::servo, m, true));
    REQUIRE((gain = only_claim(d, "drive_gain")));
    CHECK(value_of(*gain, "drive.position_gain_per_rad") == doctest::Approx(18.4).epsilon(0.01));
    // What the gain does to the path, this owner calls the same machine, and its calibration takes all of it.
    auto loose = nlohmann::json::parse(of_servo);
    auto& tolerance = loose["axes"]["q"]["tolerance"];
    for (const auto& [key, share] :
         {std::pair{"torque_constant", 0.15}, {"inertia", 0.15}, {"viscous", 0.4}, {"position_gain", 0.005}})
        tolerance[key] = share;
    CHECK(only_claim(diagnosed(loose.dump(), recorded(takes::servo, m, true)), "drive_gain"));
}
TEST_CASE("position servo: what its loop is said to have commanded, and nobody logged, judges no claim" *
          doctest::test_suite("all")) {
    auto m = servo;
    m.duty_gain = 17; // the motion alone says so: the command of the described loop is no better with it
    const auto d = diagnosed(of_servo, recorded(takes::servo, m));
    REQUIRE(d.causes.size() == 1);
    CHECK(d.causes[0].group_probability >= 0.9);
    CHECK(d.verdict == verdict::explained);
}
TEST_CASE("position servo: a profile velocity in its registers is found" * doctest::test_suite("all")) {
    auto m = servo;
    m.rate_limit = 0.1;
    const cause* limit = nullptr;
    const auto d = diagnosed(of_servo, recorded(takes::servo, m));
    REQUIRE((limit = only_claim(d, "setpoint_rate_limit")));
    CHECK(value_of(*limit, "drive.setpoint_rate_limit_rad_per_s") == doctest::Approx(0.1).epsilon(0.05));
}
TEST_CASE("position servo: the closed loop of simulate follows the machine to a few counts") {
    const auto r = recorded(takes::servo, servo);
    const auto s = simulate(read_machine(of_servo, "machine.json"), r.log);
    REQUIRE(s.axes[0].closed_loop);
    CHECK(s.axes[0].gap.position_rms_m < 5e-4);
}
TEST_CASE("a drive's description survives writing and reading") {
    for (const std::string& file : {linear(coulomb, of_pi), linear("", of_position), of_servo}) {
        const auto once = to_json(read_machine(file, "machine.json")).dump();
        CHECK(to_json(read_machine(once, "machine.json")).dump() == once);
        CHECK(once.find("\"drive\"") != once.npos);
    }
}
TEST_CASE("position drive: set-points at another rate than the readings are refused until the file says their "
          "period") {
    auto m = p_drive;
    m.position_gain = 40;
    auto log = recorded(takes::set_points, m).log;
    auto& reference = log.axes[0].reference;
    for (std::size_t k = 0; k < reference.size(); ++k) reference[k] = reference[k - k % 4];
    auto file = nlohmann::json::parse(linear(coulomb, of_position));
    try {
        check_match(read_machine(file.dump(), "machine.json"), log);
        FAIL("accepted");
    } catch (const bad_input& e) {
        CHECK(std::string(e.what()).find("set_point_period_s: is missing") != std::string::npos);
        CHECK(std::string(e.what()).find("every 4 rows") != std::string::npos);
    }
    const auto notes_with = [&](double period) {
        file["axes"]["q"]["drive"]["set_point_period_s"] = period;
        const auto machine = read_machine(file.dump(), "machine.json");
        CHECK_NOTHROW(check_match(machine, log));
        machine_log read = log;
        check_loops(machine, read);
        return read.notes.size() - log.notes.size();
    };
    CHECK(notes_with(0.004) == 0);
    CHECK(notes_with(0.008) == 1);
}
TEST_CASE("what no drive has is refused by key, value and rule") {
    const auto refused = [](const std::string& drive) {
        try {
            read_machine(linear("", drive), "m.json");
        } catch (const bad_input& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    CHECK(refused(R"("kind": "velocty")") ==
          "m.json: axes.q.drive.kind: must be one of \"current\", \"velocity\", "
          "\"position\", \"position_servo\"; did you mean velocity?");
    CHECK(refused(R"("kind": "velocity")") == "m.json: axes.q.drive.velocity_gain_N_s_per_m: is missing");
    CHECK(refused(of_p + R"(, "supply_V": 12)") ==
          "m.json: axes.q.drive.supply_V: belongs to a drive of kind position_servo; this one is velocity");
    CHECK(refused(of_p + R"(, "velocity_gian": 1)").find("unknown key") != std::string::npos);
    CHECK(refused(of_position + R"(, "set_point_period_s": 1e-7)")
              .find("must be at least sample_period_s (0.001) over 1000") != std::string::npos);
}
TEST_CASE("a log whose command the drive does not take is refused with the column to record") {
    const auto r = recorded(takes::set_points, p_drive);
    CHECK_THROWS_WITH(
        check_match(read_machine(linear("", of_p), "m.json"), r.log),
        "log.csv: axis q: its drive is of kind velocity in m.json: column q_cmd_V or q_cmd_m_per_s is "
        "missing");
}
TEST_CASE(
    "velocity drive whose loop answers within a row: what acts on the axis is suspected only, with a note") {
    auto m = p_drive;
    m.gain *= 5;
    const std::string file =
        linear("", R"("kind": "velocity", "velocity_gain_N_s_per_m": 125663.7, "velocity_per_V": 0.02)");
    auto r = recorded(takes::volts, m);
    const auto d = diagnosed(file, r);
    CHECK(std::any_of(d.causes.begin(), d.causes.end(),
                      [](const cause& c) { return c.effect == "coulomb_friction"; }));
    for (const cause& c : d.causes) CHECK(c.group_probability < 0.5);
    check_loops(read_machine(file, "machine.json"), r.log);
    CHECK(std::any_of(r.log.notes.begin(), r.log.notes.end(), [](const std::string& note) {
        return note.find("answers in 0.796 ms, and rows of 1 ms show little of it") != note.npos;
    }));
}
TEST_CASE(
    "a described velocity loop that answers between two rows is refused with what to record; beside a measured "
    "force it is not") {
    auto log = recorded(takes::volts, p_drive).log;
    const auto fast = [](const std::string& gain) {
        return read_machine(
            linear("", R"("kind": "velocity", "velocity_per_V": 0.02, "velocity_gain_N_s_per_m": )" + gain),
            "m.json");
    };
    CHECK_NOTHROW(check_loops(fast("2.5e5"), log)); // 0.4 ms beside rows of 1 ms
    try {
        check_loops(fast("2.5e6"), log);
        FAIL("accepted");
    } catch (const bad_input& e) {
        const std::string said = e.what();
        CHECK(said.find("answers in 0.04 ms (mass_kg over velocity_gain_N_s_per_m)") != said.npos);
        CHECK(said.find("record q_current_A, or faster") != said.npos);
    }
    log.axes[0].effort.assign(log.samples, 0.0);
    log.axes[0].effort_unit = "N";
    CHECK_NOTHROW(check_loops(fast("2.5e6"), log));
    log.axes[0].effort_unit = "A"; // and nothing says what force it makes
    CHECK_THROWS_AS(check_loops(fast("2.5e6"), log), bad_input);
    log.notes.clear();
    const auto notes = with_drives(fast("2.5e5"), log).notes;
    REQUIRE(notes.size() == 1);
    CHECK(
        notes[0].ends_with("axis q: the current is not used: axes.q.plant.force_constant_N_per_A turns it into "
                           "force."));
}
