// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "chain_machine.hpp"
#include "loop.hpp"
#include "motion.hpp"

/// What machines with two positions an axis do. The laws are this trial's own: contact, friction and rounding
/// step by step.
namespace quadrant_gap::trial {

/// A motor and a load under a position loop on the scale and a velocity loop on the motor: a force in both
/// directions through flanks that only push, friction on either side.
inline chain_record run_two_masses(const chain_truth& a, const std::vector<double>& reference, double period,
                                   std::uint64_t seed) {
    constexpr double coarsest = 1.25e-5;
    const auto fine = static_cast<std::size_t>(std::max(10.0, std::ceil(period / coarsest)));
    const double h = period / static_cast<double>(fine), load_mass = a.mass - a.motor_mass;
    const double together = a.motor_mass * load_mass / a.mass;
    const gears_truth& g = a.gears;
    const double damping = 0.06 * std::sqrt(g.stiffness * together);
    encoder motor(a.motor_encoder, dice(seed, 3)), scale(a.scale, dice(seed, 4));
    contact guide(a.guide, load_mass), bearing(a.motor_friction, a.motor_mass);
    double x = reference[0], v = 0, y = g.carried(x), w = 0, integral = 0, slow = 0, before = 0;
    std::vector<double> told;
    chain_record out;
    out.reference = reference;
    for (std::size_t k = 0; k < reference.size(); ++k) {
        const double read_motor = motor(x), read_scale = scale(y);
        out.motor.push_back(read_motor);
        out.scale.push_back(read_scale);
        if (k == 0) before = read_motor;
        const double filter = 2 * std::numbers::pi * a.filter_Hz * period;
        slow += filter / (1 + filter) * ((read_motor - before) / period - slow);
        before = read_motor;
        const double ahead = (reference[std::min(k + 1, reference.size() - 1)] - reference[k]) / period;
        const double e = a.position_gain * (reference[k] - (read_scale - g.carried(0))) + ahead - slow;
        integral = std::clamp(integral + a.integral * period * e, -a.limit, a.limit);
        const double faster =
            k + 2 < reference.size() ? (reference[k + 2] - reference[k + 1]) / period - ahead : 0;
        const double u = std::clamp(
            a.velocity_gain * e + integral + a.acceleration_feedforward * faster / period, -a.limit, a.limit);
        told.push_back(std::round(u * 3276.8) / 3276.8);
        out.command.push_back(told.back());
        for (std::size_t f = 0; f < fine; ++f) {
            const double since = (static_cast<double>(f) + 0.5) * h - a.delay;
            const auto rows_ago = static_cast<std::size_t>(since < 0 ? std::ceil(-since / period) : 0);
            const double acting = rows_ago > k ? 0 : told[k - rows_ago];
            const double apart = g.carried(x) - y, side = apart > 0 ? 1 : -1;
            double pressed = 0;
            if (std::abs(apart) > g.play / 2) {
                const double along = (x - g.bend_from) / g.bend_over,
                             softer = std::max(0.1, 1 + g.softer_along * (2 * along - 1));
                pressed = g.stiffness / softer * (apart - side * g.play / 2) + damping * (v - w);
                if (pressed * side < 0) pressed = 0; // a flank does not pull
            }
            const double motor_friction =
                a.motor_friction.coulomb > 0 ? bearing(v, h, a.motor_friction.coulomb) : 0;
            v += h * (a.force_constant * acting - pressed - motor_friction) / a.motor_mass;
            const double level = a.guide.coulomb > 0 ? slip_level(a.guide, y, w, 0) : 0;
            w += h *
                 (pressed + a.constant_force - viscous_force(a.guide, w) -
                  (level > 0 ? guide(w, h, level) : 0)) /
                 load_mass;
            x += h * v;
            y += h * w;
        }
        if (!(std::abs(x) < 100)) {
            out.ran_away = true;
            break;
        }
    }
    return out;
}

/// A motor that follows what is asked, counts, and a load that friction holds behind the play. The readings
/// alone, one row a period.
inline chain_record run_positions(const chain_truth& a, const motion& asked, double period, std::size_t rows,
                                  std::uint64_t seed) {
    constexpr std::size_t fine = 20;
    const double h = period / static_cast<double>(fine);
    const auto path = asked.sampled(h, rows * fine);
    encoder motor(a.motor_encoder, dice(seed, 3)), scale(a.scale, dice(seed, 4));
    const double keeps = a.follows.lag > 0 ? std::exp(-h / a.follows.lag) : 0;
    const double mean = a.follows.lag > 0 ? (1 - keeps) * a.follows.lag / h : 0;
    double follows = path[0], before = path[0], load = a.gears.carried(path[0]);
    chain_record out;
    for (std::size_t k = 0; k < rows; ++k) {
        double turned = follows;
        for (std::size_t f = 0; f < fine; ++f) {
            const double t = static_cast<double>(k * fine + f) * h;
            const double rows_late = a.follows.late / h;
            const auto whole = static_cast<std::size_t>(rows_late);
            const auto at = [&](std::size_t back) {
                return path[k * fine + f >= back ? k * fine + f - back : 0];
            };
            const double part = rows_late - static_cast<double>(whole);
            const double goal = (1 - part) * at(whole) + part * at(whole + 1);
            follows = keeps * follows + (mean - keeps) * before + (1 - mean) * goal; // exact on straight lines
            before = goal;
            turned = follows;
            for (const auto& j : a.follows.jumps)
                if (t >= j.at) turned -= j.by;
            const double driven = a.gears.carried(turned);
            load = std::clamp(load, driven - a.gears.play / 2, driven + a.gears.play / 2);
            if (f > 0) continue;
            // The row is read as its period begins.
            out.reference.push_back(path[k * fine]);
            // A counter counts what was sent, an encoder what was done.
            out.motor.push_back(motor(a.recorded == positions_recorded::counter_and_scale ? follows : turned));
            out.scale.push_back(scale(load + a.follows.scale_moves(t)));
        }
    }
    return out;
}

/// Readings without rounding and noise.
inline chain_truth ideal(chain_truth a) {
    for (encoder_truth* e : {&a.motor_encoder, &a.scale}) e->resolution = e->noise = 0;
    return a;
}

} // namespace quadrant_gap::trial
