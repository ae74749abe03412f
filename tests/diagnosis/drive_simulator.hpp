// SPDX-License-Identifier: BSL-1.0
// Long: log() is one drive with its axis, step by step.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

/// Machines whose drive closes loops of its own, stepped 400 times a row by an integrator that shares nothing
/// with the library.
namespace drive_simulator {

struct machine {
    double mass = 100, coulomb = 0, viscous = 0; ///< what the drive moves
    double give = 0; ///< displacement by which the contact of its friction gives way [m]; 0: it does not
    double velocity_per_V = 0.02, gain = 0, integral = 0;           ///< velocity loop
    double position_gain = 0, duty_gain = 0, supply = 12, kt = 0.1; ///< position loop; position servo
    double minimum_duty = 0, rate_limit = 1e9, delay = 0, count = 1e-6;
    double force_limit = 1e9;           ///< of the velocity loop [N]
    double velocity_filter = 0;         ///< time constant with which the drive measures its velocity [s]
    double off_from = 0, off_until = 0; ///< the drive gives nothing then [s]
    double clock_slip = 0;              ///< its clock's period is longer by this share
    int rows_of_a_set_point = 1;        ///< it takes a new one after so many rows
    double lost = 0;                    ///< share of the set-points that never arrive
    bool enabled_column = false;
    double force_of_current = 0;     ///< [N/A]: the drive's current is logged, too; 0: it is not
    bool current_is_mean = false;    ///< over the row; else as the row begins
    bool current_before = false;     ///< as the row before it ended: read before the set-point is handed over
    double velocity_feedforward = 0; ///< of the slope of the set-points, in a position drive
    bool stock_pid =
        /// in front of a velocity drive: P, and feedforwards of backward differences, as LinuxCNC's component
        false;
    double pgain = 1000, dgain = 0, ff0 = 0, ff1 = 0, ff2 = 0, bias = 0; ///< of the same component
    double deadband = 0;             ///< of the position error of that component [m]
    double gravity = 0;              ///< torque -gravity sin x
    double constant = 0, spring = 0; ///< force, and -spring x
    double drag = 0;                 ///< force -drag v |v|
    /// Of each row: what is added to the set-point, and to the force of the velocity loop; empty: nothing.
    std::vector<double> shift{}, added{};
};
enum class takes { volts, set_points, servo, force }; ///< force: the command is one, no loop inside

/// Strokes of three sizes with rests, one sample a period.
inline std::vector<double> strokes(double period, double seconds, double pace) {
    std::vector<double> out;
    double clock = 0;
    for (double t = 0; t < seconds; t += period) {
        const double into = std::fmod(t, 3.0);
        clock += period * std::clamp((into < 2.6 ? std::min(into, 2.6 - into) : 0.0) / 0.1, 0.0, 1.0);
        const double grown = std::clamp(t, 0.0, 1.0), turn = 2 * std::numbers::pi * pace * clock;
        out.push_back(
            grown * grown * (3 - 2 * grown) *
            (0.05 * std::sin(0.3 * turn) + 0.02 * std::sin(1.1 * turn) + 0.004 * std::sin(4.3 * turn)));
    }
    return out;
}

/// The log of such a machine as CSV. `unit`: of its lengths. `tap`: the column of the duty, too.
inline std::string log(takes kind, const machine& m, double period, double pace, unsigned seed,
                       const std::string& unit, bool tap = false) {
    constexpr int steps = 400;
    const double h = period / steps;
    const auto reference = strokes(period, 10, pace);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.3 * m.count);
    std::vector<double> command, arrived; // what the drive holds from each set-point on
    std::mt19937 dice(seed + 100);
    double x = 0, v = 0, bristle = 0, felt = 0, integral = 0, followed = 0, last = 0, force_before = 0;
    std::ostringstream out;
    out.precision(10);
    out << "t_s,q_ref_" << unit << ",q_pos_" << unit
        << (kind == takes::volts   ? ",q_cmd_V"
            : kind == takes::force ? ",q_cmd_N"
                                   : "")
        << (tap ? ",q_duty" : "") << (m.force_of_current > 0 ? ",q_current_A" : "")
        << (m.enabled_column ? ",q_enabled" : "") << "\n";
    for (std::size_t k = 0; k < reference.size(); ++k) {
        const double read = std::round((x + noise(random)) / m.count) * m.count;
        const double speed = (reference[std::min(k + 1, reference.size() - 1)] - reference[k]) / period;
        const auto ago = [&](std::size_t back) { return reference[k > back ? k - back : 0]; };
        const double behind = reference[k] - read,
                     kept = std::copysign(std::max(0.0, std::abs(behind) - m.deadband), behind);
        const double sum =
            m.stock_pid
                ? m.pgain * kept + m.dgain * (kept - last) / period + m.ff1 * (ago(0) - ago(1)) / period +
                      m.ff2 * (ago(0) - 2 * ago(1) + ago(2)) / (period * period) + m.bias + m.ff0 * reference[k]
                : (20 * (reference[k] - read) + speed) / m.velocity_per_V;
        const double volts = std::clamp(sum, -10.0, 10.0);
        last = kept;
        command.push_back(kind == takes::volts   ? volts
                          : kind == takes::force ? sum
                                                 : reference[k] + (m.shift.empty() ? 0 : m.shift[k]));
        out << static_cast<double>(k) * period << ',' << reference[k] << ',' << read;
        if (kind == takes::volts || kind == takes::force) out << ',' << command.back();
        double mean_force = 0, first_force = 0;
        for (int i = 0; i < steps; ++i) {
            const double at = static_cast<double>(k) + (i + 0.5) / steps - m.delay / period;
            const double every = m.rows_of_a_set_point * (1 + m.clock_slip);
            const double tick = std::floor(at / every); // of the drive's clock
            const auto row_of = [&](double n) {
                return static_cast<std::size_t>(std::max(0.0, n * every + 1e-9));
            };
            const std::size_t row = row_of(tick);
            const auto taken = [&](double n) { // the set-point of a tick, or the last one that arrived
                const auto last_tick = static_cast<std::size_t>(std::max(0.0, n));
                while (arrived.size() <= last_tick) {
                    const bool gone = !arrived.empty() && std::uniform_real_distribution()(dice) < m.lost;
                    arrived.push_back(gone ? arrived.back()
                                           : command[row_of(static_cast<double>(arrived.size()))]);
                }
                return arrived[last_tick];
            };
            const double now = (static_cast<double>(k) + (i + 0.5) / steps) * period;
            const bool off = now >= m.off_from && now < m.off_until;
            double force = 0;
            if (kind == takes::servo) {
                followed += std::clamp(taken(tick) - followed, -m.rate_limit * h, m.rate_limit * h);
                const double e = followed - x;
                const double duty = std::clamp(m.duty_gain * e + (e > 0 ? 1 : -1) * m.minimum_duty, -1.0, 1.0);
                if (tap && i == 0) out << ',' << duty;
                force = duty * m.supply * m.kt;
            } else if (kind == takes::force) {
                force = command[row];
            } else {
                const double part = at / every - tick, before = taken(tick - 1);
                const double asked =
                    kind == takes::volts
                        ? m.velocity_per_V * taken(tick)
                        : m.position_gain * (before + part * (taken(tick) - before) - x) +
                              m.velocity_feedforward * (taken(tick) - before) / (every * period);
                const auto newest = static_cast<std::size_t>(std::max(0.0, at)); // a force is held over a row
                const auto within = [&](double f) { return std::clamp(f, -m.force_limit, m.force_limit); };
                felt += m.velocity_filter > h ? h / m.velocity_filter * (v - felt) : v - felt;
                force = within(m.gain * (asked - felt) + integral + (m.added.empty() ? 0 : m.added[newest]));
                integral = within(integral + h * m.integral * (asked - felt));
            }
            if (off) {
                force = integral = 0;
                followed = x;
            }
            mean_force += force / steps;
            if (i == 0) first_force = m.current_before ? force_before : force;
            force_before = force;
            const double others = m.constant - m.gravity * std::sin(x) - m.spring * x;
            v += h * (force - (m.viscous + m.drag * std::abs(v)) * v + others) / m.mass;
            if (m.give > 0) {
                const double end = std::copysign(m.give, v);
                bristle = end + (bristle - end) * std::exp(-std::abs(v) * h / m.give);
                v -= h * m.coulomb * bristle / m.give / m.mass;
            } else {
                const double stop = h * m.coulomb / m.mass;
                v -= std::clamp(v, -stop, stop);
            }
            x += h * v;
        }
        const double t = static_cast<double>(k) * period;
        if (m.force_of_current > 0) { // with noise of a hundredth of the friction
            const double force = m.current_is_mean ? mean_force : first_force;
            out << ',' << (force + 0.01 * m.coulomb * noise(random) / (0.3 * m.count)) / m.force_of_current;
        }
        if (m.enabled_column) out << ',' << (t >= m.off_from && t < m.off_until ? 0 : 1);
        out << "\n";
    }
    return out.str();
}

} // namespace drive_simulator
