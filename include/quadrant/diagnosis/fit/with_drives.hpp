// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../model/driven_motion.hpp"
#include "../model/plant_model.hpp"
#include "scales.hpp"

#include <fmt/format.h>
#include <numbers>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// The unit in which something was measured behind the command; empty: nothing was.
inline std::string unit_of_measured(const axis_log& log) {
    return log.command_is == command_origin::measured ? log.command_unit
           : log.effort.empty()                       ? std::string()
                                                      : log.effort_unit;
}
/// Whether the machine file says what force a number in this unit is.
inline bool is_known_force(const axis_description& axis, const std::string& unit) {
    return is_force(unit) || (!unit.empty() && unit == axis.command_unit);
}

/// What was measured behind the drive, in the unit of what its law gives; empty: nothing. `step`: of the
/// column, in that unit.
inline std::vector<double> measured_behind(const axis_description& axis, const axis_log& log, double& step) {
    const bool servo = axis.drive.kind == drive_kind::position_servo;
    const auto scaled = [&](const std::vector<double>& x, double by, double written) {
        std::vector<double> out = x;
        for (double& v : out) v *= by;
        step = std::abs(by) * written;
        return out;
    };
    if (servo) {
        if (!log.duty.empty()) return scaled(log.duty, 1, log.duty_step);
        if (log.command_unit == "duty") return scaled(log.command, 1, log.command_step);
        if (log.command_unit == "V") return scaled(log.command, 1 / *axis.drive.supply_V, log.command_step);
        return {};
    }
    const double constant = axis.plant.force_constant_N_per_V;
    const auto force = [&](const std::vector<double>& x, const std::string& unit, double written) {
        return is_known_force(axis, unit) ? scaled(x, is_force(unit) ? 1 : constant, written)
                                          : std::vector<double>{};
    };
    if (log.command_is == command_origin::measured)
        return force(log.command, log.command_unit, log.command_step);
    return log.effort.empty() ? std::vector<double>{} : force(log.effort, log.effort_unit, log.effort_step);
}

/// Whether the log has the reading of an encoder at the motor beside that of the load.
inline bool has_motor_encoder(const axis_description& axis, const axis_log& log) {
    return !log.motor.empty() && !log.turn && axis.transmission.to_load(log.motor_unit).has_value();
}
/// The position on which a drive closes its loops: the motor's where that was read, in units of the load and
/// from its mean zero. A transmission that gives way is then outside of the loop.
inline std::vector<double> seen_by_drive(const axis_description& axis, const axis_log& log) {
    if (!has_motor_encoder(axis, log)) return log.position;
    const std::optional<double> to_load = axis.transmission.to_load(log.motor_unit);
    std::vector<double> out = log.motor;
    double zero = 0;
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k] *= *to_load;
        zero += (log.position[k] - out[k]) / static_cast<double>(out.size());
    }
    for (double& x : out) x += zero;
    return out;
}

/// Force that a plant needs for a measured motion, one a row [N]; no friction at rest, which no motion shows.
/// `count`: of the encoder.
inline std::vector<double> needed_force(const plant_model& p, const driven_motion& of, double count) {
    const auto acceleration = derivative(of.velocity, of.period);
    const double slow = count / of.period; // no reading shows a speed below it
    std::vector<double> out(of.position.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double v = of.velocity[k], direction = v == 0 ? 0 : v / (std::abs(v) + slow);
        out[k] = p.moving_mass() * acceleration[k] + p.friction.viscous_slope * v +
                 p.friction.coulomb * direction + p.holding_force(of.position[k]);
    }
    return out;
}

/// The set-points of rows that nobody read: a line, where the last one before them was held.
inline void fill_in(std::vector<double>& set_point, std::size_t first, std::size_t behind) {
    if (first == 0 || behind >= set_point.size()) return;
    const double before = set_point[first - 1], next = set_point[behind];
    for (std::size_t k = first; k < behind; ++k)
        if (set_point[k] != before) return;
    const double step = (next - before) / static_cast<double>(behind - first + 1);
    for (std::size_t k = first; k < behind; ++k)
        set_point[k] = before + step * static_cast<double>(k - first + 1);
}

/// Where the integral of a drive is found again: behind rows that nobody read, from what was measured of its
/// force, else from what the described machine needs. Of a row or two a line knows enough.
inline void find_unread_rows(driven_motion& m, const axis_log& log, const plant_model& described,
                             double count) {
    constexpr std::size_t few = 2, of_velocity = 3; // rows; as many as a velocity reaches to either side
    const double rate = m.integral_rate(described.drive);
    const auto is_read = [&](std::size_t k) {
        return k >= log.left_out.size() || !log.left_out[k] || m.is_off(k);
    };
    const std::size_t n = m.position.size();
    std::vector<double> force;
    for (std::size_t first = 0; first < std::min(n, log.left_out.size()); ++first) {
        if (is_read(first)) continue;
        std::size_t behind = first;
        while (behind < n && !is_read(behind)) ++behind;
        fill_in(m.set_point, first, behind);
        const std::size_t from = behind + of_velocity;
        if (behind - first > few && rate > 0) {
            std::size_t until = from;
            while (until < n && is_read(until) && !m.is_off(until) &&
                   static_cast<double>(until - from) < 3 / (rate * m.period))
                ++until;
            if (until >= from + of_velocity) {
                if (force.empty()) force = m.tapped() ? m.measured : needed_force(described, m, count);
                double sum = 0;
                for (std::size_t k = from; k < until; ++k) sum += force[k];
                m.unread.push_back({first, behind, from, until, sum / static_cast<double>(until - from)});
            }
        }
        first = behind;
    }
}

/// The log of an axis whose drive closes loops of its own, made ready: its command is what the actuator got.
inline axis_log with_drive(const axis_description& axis, const axis_log& log, double period) {
    axis_log out = log;
    const drive_description& d = axis.drive;
    auto motion = std::make_shared<driven_motion>();
    motion->period = period;
    motion->constant = axis.plant.force_constant_N_per_V;
    const bool command_in_m = log.command_unit == key_of("m", axis.kind);
    motion->set_point = d.kind == drive_kind::velocity || command_in_m ? log.command : log.reference;
    motion->in_volts = log.command_unit == "V";
    motion->position = seen_by_drive(axis, log);
    motion->one_encoder = !has_motor_encoder(axis, log);
    motion->off = log.drive_off;
    for (std::size_t k = 0; k < log.drive_off.size() && k < out.left_out.size(); ++k)
        if (log.drive_off[k] == 1) out.left_out[k] = 0; // the mechanics go on
    double step = 0;
    motion->measured = measured_behind(axis, log, step);
    out.asked = log.command;
    out.command_unit = axis.command_unit;
    out.command_step = 0;
    out.command_is = command_origin::asked;
    const drive_model model(d);
    const double count = std::max(
        {axis.encoder.resolution_m, log.position_step, observed_count(log.position, log.position_step)});
    motion->find_velocity();
    const plant_model described(axis, count);
    motion->mass = described.moving_mass();
    find_unread_rows(*motion, log, described, count);
    // No faster than five times the level goes: above it noise of the reading is all that an acceleration has.
    if (const double rate = motion->level_rate(model); rate > 0 && !motion->tapped())
        motion->needed = zero_phase(needed_force(described, *motion, count),
                                    std::min(0.1 / period, 5 * rate / (2 * std::numbers::pi)), period);
    const driven_motion::replay replay = motion->run(model);
    out.command = replay.command;
    if (motion->tapped() && d.kind == drive_kind::position_servo) {
        double most = 0;
        for (double u : motion->measured) most = std::max(most, std::abs(u));
        motion->to_position = reading_noise(log.position, count) /
                              duty_noise(replay.beside, std::max(step, 1e-12 * most), model.duty_gain, count);
    }
    out.drive = std::move(motion);
    return out;
}

} // namespace detail

/// Whether the force that such a drive makes was measured: no replay of it stands for the force.
inline bool shows_the_force(const axis_description& axis, const axis_log& log) {
    return log.drive ? log.drive->tapped() : detail::is_known_force(axis, detail::unit_of_measured(log));
}

/// The log with the axes of such drives made ready; the others stay as they are. A note names columns that only
/// a drive would use.
inline machine_log with_drives(const machine_description& machine, machine_log log) {
    for (axis_log& logged : log.axes)
        for (const axis_description& axis : machine.axes) {
            if (axis.name != logged.name || logged.still) continue;
            if (axis.drive.closes()) {
                const bool current = detail::unit_of_measured(logged) == "A" && axis.command_unit != "A" &&
                                     axis.drive.kind != drive_kind::position_servo;
                logged = detail::with_drive(axis, logged, machine.sample_period_s);
                if (current)
                    log.notes.push_back(fmt::format(
                        "{}: axis {}: the current is not used: axes.{}.plant.{} turns it into force.", log.file,
                        axis.name, axis.name, key_of("force_constant_N_per_A", axis.kind)));
            } else if (!logged.duty.empty() || !logged.effort.empty())
                log.notes.push_back(
                    fmt::format("{}: axis {}: what was measured beside the command is used only "
                                "where axes.{}.drive describes a drive with loops of its own.",
                                log.file, axis.name, axis.name));
        }
    return log;
}

} // namespace quadrant::inline v0::diagnosis
