// SPDX-License-Identifier: BSL-1.0
// A motor and a load, each with an encoder, from a simulator of their own: what gives way between the two, and
// the loop that a drive closes on the motor, are no causes.
#include "claims.hpp"

#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

using namespace quadrant::diagnosis;
using workshop::said;

namespace {

/// 20 kg of motor and 30 kg of load joined by 4 N/um; each side has friction. Behind a velocity drive, or a
/// current drive of 50 N/A with the control's own loop on the motor.
struct two_masses {
    double load = 30, force_constant = 50;
    bool velocity_drive = true;

    static constexpr double period = 0.001, gain = 6000, integral = 60000;

    std::string log(double slow, double fast) const {
        constexpr int fine = 50;
        constexpr double h = period / fine, motor = 20, stiffness = 4e6, damping = 600, count = 1e-7;
        std::string out = velocity_drive ? "t_s,x_cmd_m_per_s,x_motor_pos_m,x_pos_m\n"
                                         : "t_s,x_ref_m,x_cmd_A,x_motor_pos_m,x_pos_m\n";
        double xm = 0, vm = 0, xl = 0, vl = 0, sum = 0;
        const auto friction = [](double level, double v) { return level * std::tanh(v / 2e-4); };
        const auto read = [](double x) { return count * std::round(x / count); };
        for (int k = 0; k < 6000; ++k) {
            const double t = period * k, grown = std::min(1.0, t), a = 2 * std::numbers::pi * t;
            const double asked = grown * (0.03 * std::sin(slow * a) + 0.004 * std::sin(fast * a));
            const double follow = 60 * (asked - xl); // [m/s]
            double command = follow;
            if (!velocity_drive) {
                const double e = follow - vm;
                command = (gain * e + sum) / 50;
                sum += integral * e * period;
            }
            out += velocity_drive ? fmt::format("{:.4f},{:.9f},{:.8f},{:.8f}\n", t, command, read(xm), read(xl))
                                  : fmt::format("{:.4f},{:.8f},{:.7f},{:.8f},{:.8f}\n", t, asked, command,
                                                read(xm), read(xl));
            for (int i = 0; i < fine; ++i) {
                double force = force_constant * command;
                if (velocity_drive) {
                    const double e = command - vm;
                    force = gain * e + sum;
                    sum += integral * e * h;
                }
                const double through = stiffness * (xm - xl) + damping * (vm - vl);
                vm += h / motor * (force - through - friction(15, vm));
                vl += h / load * (through - friction(25, vl) - 80 * vl);
                xm += h * vm, xl += h * vl;
            }
        }
        return out;
    }

    diagnosis_result diagnosed() const {
        const std::string drive = velocity_drive
                                      ? R"("drive": {"kind": "velocity", "velocity_gain_N_s_per_m": 6000,
            "velocity_integral_N_per_m": 60000},)"
                                      : "";
        const std::string constant = velocity_drive ? "" : R"("force_constant_N_per_A": 50, )";
        const auto machine = read_machine(
            std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"x": {)" +
                             drive + R"("plant": {)" + constant +
                             R"("mass_kg": 50, "viscous_N_s_per_m": 80, "coulomb_N": 25},
                "transmission": {"kind": "belt", "motor_mass_kg": 20, "stiffness_N_per_m": 4e6, "motor_coulomb_N": 15},
                "tolerance": {"mass": 0.03, "viscous": 0.1, "coulomb": 0.05, "motor_coulomb": 0.05, "stiffness": 0.05,
                              "force_constant": 0.02, "velocity_gain": 0.02, "velocity_integral": 0.05},
                "encoder": {"resolution_m": 1e-7}, "motor_encoder": {"resolution_m": 1e-7}}}})"),
            "two_masses.json");
        const auto read = [](const std::string& csv) {
            std::istringstream text(csv);
            return read_log(text, "two_masses.csv");
        };
        const machine_log log = read(this->log(0.4, 4)), holdout = read(this->log(0.6, 3));
        return diagnose(machine, log, &holdout);
    }
};

/// Names other than this one said at one half and more.
std::string others(const diagnosis_result& d, std::string_view but) {
    std::string out;
    for (const cause& c : d.causes)
        if (c.effect != but && c.probability >= 0.5) out += fmt::format("{} {:.2f} ", c.effect, c.probability);
    return out;
}

/// What a cause says of this key; 0 where none does.
double value_found(const diagnosis_result& d, std::string_view key) {
    for (const cause& c : d.causes)
        for (const auto& p : c.parameters)
            if (p.key == key) return p.values.at(0).value;
    return 0;
}

} // namespace

TEST_CASE("two encoders behind a velocity drive: its loop is on the motor, and nobody is blamed") {
    const diagnosis_result d = two_masses{}.diagnosed();
    INFO(said(d));
    CHECK(d.verdict <= verdict::within_tolerance);
    CHECK(others(d, "").empty());
}

TEST_CASE("two encoders behind a velocity drive: a heavier load is the only cause") {
    const diagnosis_result d = two_masses{.load = 40}.diagnosed();
    INFO(said(d));
    CHECK(others(d, "mass").empty());
    CHECK(value_found(d, "mass_kg") == doctest::Approx(60).epsilon(0.05));
}

TEST_CASE("two encoders: a force constant that differs is neither wind-up nor friction on the motor") {
    const diagnosis_result d = two_masses{.force_constant = 40, .velocity_drive = false}.diagnosed();
    INFO(said(d));
    CHECK(others(d, "force_constant").empty());
    CHECK(value_found(d, "force_constant_N_per_V") == doctest::Approx(40).epsilon(0.05));
}
