// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "diagnosis/claims.hpp"

/// A rotary axis that turns an arm, simulated by code that shares nothing with the diagnosis: bare doubles,
/// twenty steps a period, friction by LuGre bristles, P on the angle and PI on its difference.
namespace arms {

using namespace workshop;

inline constexpr double step = 1e-3, least_angle = 2 * std::numbers::pi / (1 << 20);

struct arm {
    double inertia = 0.17, torque_constant = 1.2, viscous = 0.05, coulomb = 0.16;
    double gravity = 0, phase = 0; ///< torque -gravity sin(q - phase)
    double load_friction = 0;      ///< level's growth with what the gear carries
    double constant = 0, spring = 0;
    double curve = 0;              ///< torque -curve q^2
    double cogging = 0, pitch = 0; ///< the first of five harmonics, each 0.6 times that before
    double low = -1.4, high = 1.4; ///< angles between which it moves
};

/// Moves between the ends, at first fast, then slowly, then in parts, with a rest after each: minimum jerk.
inline std::vector<double> turns(const arm& a) {
    std::vector<double> out;
    double at = 0.5 * (a.low + a.high);
    const auto to = [&](double share, double seconds, double rest) {
        const double from = at;
        at = a.low + share * (a.high - a.low);
        for (double t = 0; t < seconds; t += step) {
            const double s = t / seconds;
            out.push_back(from + (at - from) * s * s * s * (10 + s * (6 * s - 15)));
        }
        for (double t = 0; t < rest; t += step) out.push_back(at);
    };
    to(0.5, 0.05, 0.05);
    for (const double seconds : {0.7, 1.2, 2.0}) {
        to(1, seconds, 0.1);
        to(0, seconds, 0.1);
    }
    for (const double share : {0.3, 0.6, 1.0, 0.7, 0.4, 0.0}) to(share, 0.35, 0.08);
    return out;
}

inline machine_log run(const arm& a, unsigned seed = 1) {
    axis_log log;
    log.name = "q";
    log.kind = axis_kind::rotary;
    log.command_unit = "A";
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.5 * least_angle);
    const int fine = 20;
    const double h = step / fine, bristle = 2 * least_angle;
    const auto reference = turns(a);
    double q = reference[0], v = 0, z = 0, before = q, integral = 0;
    for (const double r : reference) {
        const double y = std::round((q + noise(random)) / least_angle) * least_angle;
        const double speed = 30 * (r - y) - (y - before) / step;
        before = y;
        integral += 40 * step * speed;
        const double u = 6 * speed + integral;
        log.reference.push_back(r);
        log.position.push_back(y);
        log.command.push_back(u);
        for (int i = 0; i < fine; ++i) {
            const double motor = a.torque_constant * u;
            const double carried =
                a.gravity * std::sin(q - a.phase) - a.constant + (a.spring + a.curve * q) * q;
            double magnets = 0;
            for (int n = 1; n <= 5 && a.cogging > 0; ++n)
                magnets +=
                    a.cogging * std::pow(0.6, n - 1) * std::sin(2 * std::numbers::pi * n * q / a.pitch + n);
            const double level = a.coulomb + a.load_friction * std::abs(motor + carried);
            const double side = v > 0 ? 1 : v < 0 ? -1 : 0, stiffness = level / bristle, was = z;
            z = side * bristle + (z - side * bristle) * std::exp(-std::abs(v) * h / bristle);
            double friction = a.viscous * v + stiffness * z;
            friction += 0.7 * std::sqrt(stiffness * a.inertia) * (z - was) / h;
            const double before_v = v;
            v += h * (motor + magnets - carried - friction) / a.inertia;
            q += h * (before_v + v) / 2;
        }
    }
    log.reference_step = log.position_step = 1e-12;
    machine_log out;
    out.sample_period_s = step;
    out.samples = log.position.size();
    out.axes.push_back(std::move(log));
    return out;
}

/// The machine file of an arm without what its weight and its gear do; numbers inside the owner's tolerance.
inline machine_description described(const arm& a) {
    axis_description d;
    d.name = "q";
    d.kind = axis_kind::rotary;
    d.command_unit = "A";
    d.plant.mass_kg = a.inertia * 1.01;
    d.plant.force_constant_N_per_V = a.torque_constant * 0.995;
    d.plant.viscous_N_s_per_m = a.viscous * 0.96;
    if (a.coulomb > 0) d.plant.coulomb_N = a.coulomb * 1.02;
    d.tolerance.given = {{"mass", 0.02}, {"force_constant", 0.01}, {"viscous", 0.1}, {"coulomb", 0.05}};
    d.encoder.resolution_m = least_angle;
    machine_description out;
    out.sample_period_s = step;
    out.axes.push_back(d);
    return out;
}

} // namespace arms
