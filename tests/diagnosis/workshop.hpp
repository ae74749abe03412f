// SPDX-License-Identifier: BSL-1.0
// Long: run() is one machine with its controller, sample by sample.
#pragma once
#include <quadrant/diagnosis/fit/scales.hpp>
#include <quadrant/diagnosis/log/log.hpp>
#include <quadrant/diagnosis/machine/machine.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

/// Machines for the tests of the diagnosis, simulated by code that shares nothing with it: bare doubles, twenty
/// steps a period, friction by LuGre bristles (the diagnosis knows sticking contacts), its own copy of the
/// controller.
namespace workshop {

struct controller {
    double position_gain = 110, velocity_gain = 35, integral = 300, filter_Hz = 180;
    double velocity_feedforward = 1, acceleration_feedforward = 0.16, viscous_feedforward = 0.22,
           coulomb_feedforward = 0;
};

struct machine {
    double mass = 180, force_constant = 1100, viscous = 250, delay = 0.0006;
    double coulomb = 60, excess = 0, stribeck_velocity = 0.004;
    double viscous_asymmetry = 0, constant_force = 0;
    double cogging = 0, cogging_second = 0, cogging_period = 0.03;
    double lag = 0;                                                 ///< first-order current loop [s]
    double spring = 0;                                              ///< [N/m]
    double backlash = 0;                                            ///< play between motor and encoder [m]
    double dead_zone = 0, drive_limit = 100, loss = 0;              ///< [V], [V], probability
    double ripple = 0, ripple_period = 0.024;                       ///< of the force constant
    double friction_along = 0, friction_along_period = 0.07;        ///< of the Coulomb level
    double friction_drift = 0, friction_drift_time = 3;             ///< of the Coulomb level
    double mode_mass = 0, mode_frequency = 70, mode_damping = 0.03; ///< second mass; not part of `mass` here
    double cyclic = 0, cyclic_period = 0.0004;                      ///< of the encoder [m]
    double cutting = 0, cutting_frequency = 23.3, cutting_second = 0.5; ///< [N], [Hz], share of the first
    double coupling = 0;                                                ///< of `other_acceleration`
    std::function<double(double)> other_acceleration = [](double) { return 0.0; };
    std::function<double(double, double, double)> stranger; ///< a force over position, velocity and time [N]
    /// Growth of the friction's level [N], from the motor's force and the constant forces on its load.
    std::function<double(double, double)> more_level;
    double bristle = 2e-7, bristle_damping = 0.7; ///< the latter over the root of stiffness and mass
    double noise = 8e-8; ///< of the encoder, white [m]
    controller control;
    std::function<double(double, double)>
        law; ///< in the controller's place: reference, reading, then the command [V]
};

inline constexpr double period = 0.0005, count = 2.5e-7, limit = 10, dac = 20.0 / 65536;
/// Scales of a usual machine tool, where no record measures them.
inline constexpr quadrant::diagnosis::record_scales usual{
    .travel = 0.2, .speed = 0.25, .command = 10, .count = count, .corner_Hz = 60};

/// Strokes in both directions at three speeds, reversals from 20 mm down to 0.3 mm, rest, and a multi-sine of
/// 15 to 140 Hz.
inline double motion(double t) {
    struct piece {
        double begin, end;
        std::function<double(double)> at;
    };
    constexpr double two_pi = 2 * std::numbers::pi;
    const auto stroke = [](double length, double time) { // constant speed between smooth ends
        return [=](double s) {
            const double ramp = 0.12, speed = length / (time - ramp);
            if (s < ramp) return speed * (s / 2 - ramp / two_pi * std::sin(std::numbers::pi * s / ramp) * 0.5);
            if (s > time - ramp) {
                const double r = time - s;
                return length - speed * (r / 2 - ramp / two_pi * std::sin(std::numbers::pi * r / ramp) * 0.5);
            }
            return speed * (s - ramp / 2);
        };
    };
    const auto swing = [](double amplitude, double frequency) {
        return [=](double s) { return amplitude * (1 - std::cos(two_pi * frequency * s)) / 2; };
    };
    const auto tones = [](double s) {
        double sum = 0;
        for (int i = 0; i < 9; ++i) {
            const double f = 15 * std::pow(1.32, i);
            sum += 0.02 / (f * f) * std::sin(two_pi * f * s + 1.7 * i * i);
        }
        return sum * std::min({1.0, s / 0.1, (0.9 - s) / 0.1});
    };
    static const std::vector<piece> pieces{{0.10, 0.90, stroke(0.12, 0.8)}, {1.00, 1.80, stroke(-0.12, 0.8)},
                                           {1.90, 2.90, stroke(0.04, 1.0)}, {3.00, 4.00, stroke(-0.04, 1.0)},
                                           {4.05, 5.05, swing(0.02, 2)},    {5.10, 6.10, swing(0.002, 2)},
                                           {6.15, 7.15, swing(0.0003, 2)},  {7.20, 8.10, tones}};
    double x = 0;
    for (const auto& p : pieces)
        if (t >= p.end)
            x += p.at(p.end - p.begin);
        else if (t > p.begin)
            x += p.at(t - p.begin);
    return x;
}

inline constexpr double three_strokes = 2.95, strokes = 4.15; ///< of motion(), where the rest is not needed [s]

/// The log of a machine that follows motion() under its controller, or a reference of one position a row.
inline quadrant::diagnosis::axis_log run(const machine& m, double seconds = 8.15, unsigned seed = 1,
                                         const std::vector<double>& reference = {}) {
    quadrant::diagnosis::axis_log log;
    log.name = "x";
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, m.noise);
    const int fine = 20;
    const double h = period / fine;
    double x = 0, v = 0, z = 0, lagged = 0, load = 0, second = 0, second_v = 0;
    double estimate = 0, y1 = 0, integral = 0, r1 = 0, v1 = 0;
    std::vector<double> commands;
    for (std::size_t k = 0; k < static_cast<std::size_t>(seconds / period); ++k) {
        const double asked = reference.empty() ? motion(static_cast<double>(k) * period) : reference[k];
        const double r = std::round(asked * 1e12) / 1e12;
        const double seen = m.backlash > 0 ? load : x;
        const double y = std::round((seen + m.cyclic * std::sin(2 * std::numbers::pi * seen / m.cyclic_period) +
                                     (k > 0 ? noise(random) : 0)) /
                                    count) *
                         count;
        const double w = 2 * std::numbers::pi * m.control.filter_Hz;
        estimate = ((2 - w * period) * estimate + 2 * w * (y - y1)) / (2 + w * period);
        y1 = y;
        const double vr = (r - r1) / period, ar = (vr - v1) / period;
        r1 = r;
        v1 = vr;
        const double e = m.control.position_gain * (r - y) + m.control.velocity_feedforward * vr - estimate;
        integral = std::clamp(integral + m.control.integral * period * e, -limit, limit);
        double u = m.control.velocity_gain * e + integral + m.control.acceleration_feedforward * ar +
                   m.control.viscous_feedforward * vr +
                   m.control.coulomb_feedforward * (vr > 0   ? 1
                                                    : vr < 0 ? -1
                                                             : 0);
        if (m.law) u = m.law(r, y);
        u = std::round(std::clamp(u, -limit, limit) / dac) * dac;
        const bool lost = m.loss > 0 && k > 0 && std::uniform_real_distribution<double>(0, 1)(random) < m.loss;
        commands.push_back(lost ? commands.back() : u);
        log.reference.push_back(r);
        log.position.push_back(y);
        log.command.push_back(u);
        for (int i = 0; i < fine; ++i) {
            const double t = (static_cast<double>(k * fine) + i) * h - m.delay;
            const double told = t < 0 ? 0 : commands[std::min(k, static_cast<std::size_t>(t / period + 1e-9))];
            const double over =
                told > 0 ? std::max(0.0, told - m.dead_zone) : std::min(0.0, told + m.dead_zone);
            const double acting = std::clamp(over, -m.drive_limit, m.drive_limit);
            lagged = m.lag > 0 ? acting + (lagged - acting) * std::exp(-h / m.lag) : acting;
            const double side = v > 0 ? 1 : v < 0 ? -1 : 0;
            const double now = static_cast<double>(k) * period;
            const double motor = m.force_constant *
                                 (1 + m.ripple * std::sin(2 * std::numbers::pi * x / m.ripple_period)) * lagged;
            const double level =
                m.coulomb *
                    (1 + m.friction_along * std::sin(2 * std::numbers::pi * x / m.friction_along_period)) *
                    (1 + m.friction_drift * (1 - std::exp(-now / m.friction_drift_time))) +
                m.excess * std::exp(-std::abs(v) / m.stribeck_velocity) +
                (m.more_level ? m.more_level(motor, m.constant_force - m.spring * x) : 0);
            double friction = m.viscous * (1 + m.viscous_asymmetry * side) * v;
            if (level > 0) { // LuGre, the bristle's exact exponential step
                const double stiffness = level / m.bristle, before = z;
                z = side * m.bristle + (z - side * m.bristle) * std::exp(-std::abs(v) * h / m.bristle);
                friction += stiffness * z + m.bristle_damping * std::sqrt(stiffness * m.mass) * (z - before) / h;
            }
            const double angle = 2 * std::numbers::pi * x / m.cogging_period;
            double force = motor - friction + m.constant_force - m.spring * x +
                           m.cogging * std::sin(angle + 0.7) + m.cogging_second * std::sin(2 * angle) +
                           m.mass * m.coupling * m.other_acceleration(now);
            const double turn = 2 * std::numbers::pi * m.cutting_frequency * now;
            force += m.cutting * (std::sin(turn + 0.4) + m.cutting_second * std::sin(2 * turn));
            if (m.stranger) force += m.stranger(x, v, now);
            if (m.mode_mass > 0) {
                const double w0 = 2 * std::numbers::pi * m.mode_frequency;
                const double pull =
                    m.mode_mass * (w0 * w0 * (second - x) + 2 * m.mode_damping * w0 * (second_v - v));
                force += pull;
                second_v -= h * pull / m.mode_mass;
                second += h * second_v;
            }
            const double before_v = v;
            v += h * force / m.mass;
            x += h * (before_v + v) / 2; // the velocity alone would lead by half a step
            load = std::clamp(load, x - m.backlash / 2, x + m.backlash / 2);
        }
    }
    log.reference_step = 1e-12;
    log.position_step = 1e-12;
    return log;
}

/// Within a share of the truth, however small that is in SI (doctest's Approx adds one to the scale).
inline bool near(double value, double truth, double share) {
    return std::abs(value - truth) <= share * std::abs(truth);
}

/// The machine file of a machine: its numbers moved inside the owner's tolerance; effects are left out by the
/// caller.
inline quadrant::diagnosis::machine_description described(const machine& m) {
    using namespace quadrant::diagnosis;
    axis_description a;
    a.name = "x";
    a.plant.mass_kg = m.mass * 1.012;
    a.plant.force_constant_N_per_V = m.force_constant * 0.996;
    a.plant.viscous_N_s_per_m = m.viscous * 0.95;
    a.plant.delay_s = m.delay;
    if (m.coulomb > 0) a.plant.coulomb_N = m.coulomb * 1.03;
    a.tolerance.given = {
        {"mass", 0.02}, {"force_constant", 0.01}, {"viscous", 0.1}, {"coulomb", 0.05}, {"static", 0.05}};
    a.encoder.resolution_m = count;
    a.actuator = {.limit_V = limit, .dac_bits = 16, .dac_range_V = 20};
    a.controller = controller_description{
        .kind = "cascade_p_pi",
        .values = {{"position_gain_per_s", {m.control.position_gain}},
                   {"velocity_gain_V_s_per_m", {m.control.velocity_gain}},
                   {"velocity_integral_V_per_m", {m.control.integral}},
                   {"velocity_filter_Hz", {m.control.filter_Hz}},
                   {"velocity_feedforward", {m.control.velocity_feedforward}},
                   {"acceleration_feedforward_V_s2_per_m", {m.control.acceleration_feedforward}},
                   {"viscous_feedforward_V_s_per_m", {m.control.viscous_feedforward}},
                   {"coulomb_feedforward_V", {m.control.coulomb_feedforward}}}};
    machine_description out;
    out.sample_period_s = period;
    out.axes.push_back(a);
    return out;
}

/// A column that was recorded some rows later than it was, negative: earlier.
inline void stand_later(std::vector<double>& column, std::ptrdiff_t rows) {
    if (rows == 0) return;
    std::rotate(column.begin(), rows > 0 ? column.end() - rows : column.begin() - rows, column.end());
    if (rows > 0)
        std::fill_n(column.begin(), rows, column[static_cast<std::size_t>(rows)]);
    else
        std::fill_n(column.end() + rows, -rows, *(column.end() + rows - 1));
}

inline quadrant::diagnosis::machine_log as_log(quadrant::diagnosis::axis_log axis) {
    quadrant::diagnosis::machine_log out;
    out.sample_period_s = period;
    out.samples = axis.position.size();
    out.axes.push_back(std::move(axis));
    return out;
}

/// The log of a rotary axis q of which position and torque alone are known, in rows of this period.
inline quadrant::diagnosis::machine_log torque_log(std::vector<double> position, std::vector<double> torque,
                                                   double row, double position_step) {
    quadrant::diagnosis::axis_log q;
    q.name = "q";
    q.kind = quadrant::diagnosis::axis_kind::rotary;
    q.command_unit = "Nm";
    q.has_reference = false;
    q.reference = position;
    q.position = std::move(position);
    q.command = std::move(torque);
    q.position_step = position_step;
    auto out = as_log(std::move(q));
    out.file = "log.csv";
    out.sample_period_s = row;
    return out;
}

} // namespace workshop
