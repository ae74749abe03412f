// SPDX-License-Identifier: BSL-1.0
// Motor and load with a play between them and one encoder, from a simulator of their own: a stiff contact that
// rebounds, friction that is smooth in the speed. The plant of the diagnosis has neither.
#include "claims.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>
#include <string>

using namespace quadrant::diagnosis;
using workshop::said;

namespace {

/// 8 kg of motor and 16 kg of load, joined by a play; the loop is closed on the encoder.
struct loose_drive {
    double play = 40e-6, motor_friction = 1, load_friction = 30;
    bool encoder_on_motor = true;

    static constexpr double period = 0.001, motor = 8, load = 16, viscous = 12;

    std::string log(double slow, double fast) const {
        constexpr int fine = 200;
        constexpr double h = period / fine, stiffness = 4e7, damping = 4e3, count = 5e-7;
        const auto friction = [](double level, double v) { return level * std::tanh(v / 1e-4); };
        std::string out = "t_s,x_ref_m,x_cmd_N,x_pos_m\n";
        double xm = 0, vm = 0, xl = 0, vl = 0, sum = 0, before = 0;
        for (int k = 0; k < 8000; ++k) {
            const double t = period * k, grown = std::min(1.0, t), turn = 2 * std::numbers::pi * t;
            const double asked = grown * (0.02 * std::sin(slow * turn) + 0.003 * std::sin(fast * turn));
            const double read = count * std::round((encoder_on_motor ? xm : xl) / count);
            const double e = 40 * (asked - read) - (read - before) / period;
            const double command = 1500 * e + sum;
            sum += 3e4 * e * period;
            before = read;
            char row[96];
            std::snprintf(row, sizeof row, "%.4f,%.9f,%.7f,%.8f\n", t, asked, command, read);
            out += row;
            for (int i = 0; i < fine; ++i) {
                const double apart = xm - xl, beyond = apart - std::clamp(apart, -play / 2, play / 2);
                double through = 0;
                if (beyond != 0) through = stiffness * beyond + damping * (vm - vl);
                if (through * beyond < 0) through = 0; // it does not stick to the flank
                vm += h / motor * (command - through - friction(motor_friction, vm));
                vl += h / load * (through - friction(load_friction, vl) - viscous * vl);
                xm += h * vm, xl += h * vl;
            }
        }
        return out;
    }
    /// `more`: of the plant.
    machine_description described(const std::string& more = "") const {
        return read_machine(std::string_view(fmt::format(
                                R"({{"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {{"x": {{
            "plant": {{"mass_kg": 24, "viscous_N_s_per_m": 12, "coulomb_N": {}{}}},
            "tolerance": {{"mass": 0.02, "viscous": 0.1, "coulomb": 0.05}},
            "encoder": {{"resolution_m": 5e-7}}}}}}}})",
                                motor_friction + load_friction, more)),
                            "loose.json");
    }
    machine_log read(double slow, double fast) const {
        std::istringstream file(log(slow, fast));
        return read_log(file, "loose.csv");
    }
    diagnosis_result diagnosed() const { return diagnose(described(), read(0.4, 3.1)); }
};

double found(const diagnosis_result& d, std::string_view effect, std::string_view key) {
    for (const cause& c : d.causes)
        if (c.effect == effect && c.group_probability > 0.8)
            for (const auto& p : c.parameters)
                if (p.key == key) return p.values.at(0).value;
    return 0;
}
bool claims_another(const diagnosis_result& d) {
    return std::any_of(d.causes.begin(), d.causes.end(),
                       [](const cause& c) { return c.effect != "backlash" && c.group_probability > 0.5; });
}

} // namespace

TEST_CASE("diagnose: play behind an encoder on the motor, with the motor's own mass") {
    const loose_drive machine;
    const auto d = machine.diagnosed();
    CAPTURE(said(d));
    CHECK(found(d, "backlash", "backlash_behind_m") == doctest::Approx(machine.play).epsilon(0.1));
    CHECK(found(d, "backlash", "backlash_motor_mass_kg") == doctest::Approx(machine.motor).epsilon(0.1));
    CHECK_FALSE(claims_another(d));
}

TEST_CASE(
    "diagnose: play before an encoder on a load that its friction holds: width times motor mass is found") {
    loose_drive machine;
    machine.encoder_on_motor = false;
    const auto d = machine.diagnosed();
    CAPTURE(said(d));
    const double width = found(d, "backlash", "backlash_m"),
                 mass = found(d, "backlash", "backlash_motor_mass_kg");
    CHECK(width * mass == doctest::Approx(machine.play * machine.motor).epsilon(0.25));
    CHECK_FALSE(claims_another(d));
}

TEST_CASE("diagnose: with the motor's mass stated, the width of such a play is known") {
    loose_drive machine;
    machine.encoder_on_motor = false;
    const auto d = diagnose(machine.described(R"(, "backlash_motor_mass_kg": 8)"), machine.read(0.4, 3.1));
    CAPTURE(said(d));
    CHECK(found(d, "backlash", "backlash_m") == doctest::Approx(machine.play).epsilon(0.2));
    CHECK_FALSE(claims_another(d));
}

TEST_CASE("diagnose: a load that coasts across the play where the motor brakes") {
    loose_drive machine;
    machine.load_friction = 3;
    const auto d = machine.diagnosed();
    CAPTURE(said(d));
    CHECK(found(d, "backlash", "backlash_behind_m") == doctest::Approx(machine.play).epsilon(0.15));
    CHECK_FALSE(claims_another(d));
}

TEST_CASE("diagnose: no play where there is none") {
    loose_drive machine;
    machine.play = 0;
    for (const bool on_motor : {true, false}) {
        machine.encoder_on_motor = on_motor;
        const auto d = machine.diagnosed();
        CAPTURE(said(d));
        CHECK(found(d, "backlash", "backlash_m") + found(d, "backlash", "backlash_behind_m") == 0);
        CHECK_FALSE(claims_another(d));
    }
}

TEST_CASE("apply: what was found of a play makes the simulation follow another motion") {
    const loose_drive machine;
    const auto described = machine.described();
    const auto corrected = apply(described, machine.diagnosed());
    const auto other = machine.read(0.7, 2.3);
    const double before = simulate(described, other).axes.at(0).gap.force_rms_N,
                 after = simulate(corrected, other).axes.at(0).gap.force_rms_N;
    CHECK(after < 0.5 * before);
}
