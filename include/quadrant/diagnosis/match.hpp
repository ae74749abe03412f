// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "fit/with_drives.hpp"
#include "log/gantry_pair.hpp"
#include "log/log.hpp"
#include "machine/machine.hpp"
#include "machine/set_point_rows.hpp"
#include "text/bad_input.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadrant::inline v0::diagnosis {

/// Whether a log has the sample period of the machine file, to a hundredth.
inline bool has_period_of(const machine_description& machine, const machine_log& log) {
    constexpr double allowed = 0.01;
    return std::abs(log.sample_period_s / machine.sample_period_s - 1) <= allowed;
}

namespace detail {

/// Refuses a log whose command a drive of this kind does not take.
inline void check_drive(const axis_description& axis, const axis_log& log, const std::string& machine,
                        const std::string& file) {
    const std::string m = key_of("m", axis.kind), unit = log.command_unit;
    const bool measured = log.command_is == command_origin::measured;
    const auto refuse = [&](const std::string& what) {
        throw bad_input(file, fmt::format("axis {}: its drive is of kind {} in {}: {}", axis.name,
                                          name_of(axis.drive.kind), machine, what));
    };
    if (axis.drive.kind == drive_kind::velocity) {
        if (unit != "V" && unit != m + "_per_s")
            refuse(fmt::format(
                "column {0}_cmd_V or {0}_cmd_{1}_per_s is missing{2}", axis.name, m,
                unit.empty() || measured ? "" : fmt::format("; {0}_cmd_{1} is none of them", axis.name, unit)));
        if (unit == "V" && !axis.drive.velocity_per_V)
            throw bad_input(machine,
                            fmt::format("axes.{0}.drive.velocity_per_V: is missing; the command column of "
                                        "{1} is {0}_cmd_V",
                                        axis.name, file));
        return;
    }
    const bool servo = axis.drive.kind == drive_kind::position_servo;
    if (!unit.empty() && !measured && unit != m && !(servo && (unit == "V" || unit == "duty")))
        refuse(fmt::format("it takes positions, column {0}_cmd_{1} or {0}_ref_{1}, not {0}_cmd_{2}", axis.name,
                           m, unit));
    if (const auto rows = rows_of_a_set_point(unit == m ? log.command : log.reference);
        rows > 1 && axis.drive.kind == drive_kind::position && !axis.drive.set_point_period_s)
        throw bad_input(machine,
                        fmt::format("axes.{0}.drive.set_point_period_s: is missing; the set-points in {1} "
                                    "change every {2} rows",
                                    axis.name, file, rows));
    if (unit != m && !log.has_reference)
        refuse(fmt::format("column {0}_cmd_{1} or {0}_ref_{1}, what the drive received, is missing", axis.name,
                           m));
}

/// Refuses a described velocity loop that answers faster than two rows of the log can show: its force is the
/// gain times an error that lies between the rows. A force that was measured behind it needs no replay.
inline void check_speed_of_loop(const axis_description& axis, const machine_description& machine,
                                const axis_log& log, machine_log& whole) {
    const double answer = axis.answer_of_loop(), shortest = machine.sample_period_s / std::numbers::pi;
    if (log.still || shows_the_force(axis, log)) return;
    if (answer >= shortest) {
        if (answer < machine.sample_period_s)
            whole.notes.push_back(fmt::format(
                "{}: axis {}: the velocity loop of the drive answers in {:.3g} ms, and rows of {:.3g} ms show "
                "little of it: what acts on the axis is suspected only; record the current or the torque, or "
                "faster.",
                whole.file, axis.name, 1e3 * answer, 1e3 * machine.sample_period_s));
        return;
    }
    throw bad_input(
        whole.file,
        fmt::format("axis {0}: the velocity loop of axes.{0}.drive in {1} answers in {2:.3g} ms ({3} over "
                    "{4}), and rows of {5:.3g} ms do not show it: record {0}_current_A{6}, "
                    "or faster, or describe no plant (then its positions alone are diagnosed)",
                    axis.name, machine.file, 1e3 * answer, key_of("mass_kg", axis.kind),
                    key_of("velocity_gain_N_s_per_m", axis.kind), 1e3 * machine.sample_period_s,
                    and_torque(" or ", axis.name, axis.kind)));
}

/// Refuses a log with one position only of an axis that is a chain of them.
inline void check_positions(const axis_description& axis, const axis_log& log, const std::string& file) {
    const std::string m = key_of("m", axis.kind);
    if (log.has_reference || !log.motor.empty() || log.still) return;
    const std::string in_metres = m == "m" ? fmt::format(" or {}_motor_pos_m", axis.name) : "",
                      set_points = log.command_unit == m
                                       ? fmt::format(" (name {0}_cmd_{1} {0}_ref_{1}: it is what was asked)",
                                                     axis.name, m)
                                       : "";
    throw bad_input(file,
                    fmt::format("axis {0}: column {0}_ref_{1} or {0}_motor_pos_rad{2} is missing: without a "
                                "plant two positions are compared{3}",
                                axis.name, m, in_metres, set_points));
}

} // namespace detail

/// Refuses a machine of which nothing but positions is known, for what needs its forces: bad_input. The
/// difference of a gantry's ends beside the beam itself is only left out.
inline void refuse_positions_only(const machine_description& machine, std::string_view what) {
    const bool of_a_gantry = std::any_of(machine.axes.begin(), machine.axes.end(),
                                         [](const axis_description& a) { return !a.positions_only; });
    for (const axis_description& axis : machine.axes)
        if (axis.positions_only && !(axis.gantry_pair && of_a_gantry))
            throw bad_input(
                machine.file,
                fmt::format("axes.{}.plant: is missing; {} needs the forces of the axis", axis.name, what));
}

/// Joins the ends of gantries (join_gantry_pairs()) and leaves out the axes of a log that the machine file says
/// nothing of, with a note, when it describes another of them: the recorder of a robot writes all joints, and
/// an owner begins with one.
inline void keep_described(const machine_description& machine, machine_log& log) {
    join_gantry_pairs(machine, log);
    const auto described = [&](const axis_log& a) {
        return std::any_of(machine.axes.begin(), machine.axes.end(),
                           [&](const axis_description& axis) { return axis.name == a.name; });
    };
    if (std::none_of(log.axes.begin(), log.axes.end(), described)) return;
    std::string names;
    for (const axis_log& a : log.axes) {
        if (described(a)) continue;
        names += (names.empty() ? "" : ", ") + a.name;
        const std::string of_it = fmt::format(": axis {} ", a.name);
        std::erase_if(log.notes, [&](const std::string& note) { return note.find(of_it) != note.npos; });
    }
    if (names.empty()) return;
    log.notes.push_back(fmt::format("{}: left out, not described in {}: axis {}.", detail::one_line(log.file),
                                    detail::one_line(machine.file), names));
    for (axis_log& a : log.axes)
        if (!described(a)) log.beside.push_back(a);
    std::erase_if(log.axes, [&](const axis_log& a) { return !described(a); });
}

/// Refuses, beyond check_match(), what cannot be diagnosed: bad_input. A note says where a log's set-points
/// come at another rate than its machine file says.
inline void check_loops(const machine_description& machine, machine_log& log) {
    for (const axis_description& axis : machine.axes)
        for (const axis_log& logged : log.axes) {
            if (logged.name != axis.name || axis.positions_only) continue;
            detail::check_speed_of_loop(axis, machine, logged, log);
            const auto& period = axis.drive.set_point_period_s;
            if (!axis.drive.closes() || !period) continue;
            const bool commanded =
                axis.drive.kind == drive_kind::velocity || logged.command_unit == key_of("m", axis.kind);
            const std::size_t rows = rows_of_a_set_point(commanded ? logged.command : logged.reference);
            const double seen = static_cast<double>(rows) * machine.sample_period_s;
            const bool between = rows == 1 && *period < 0.999 * seen;
            if (between || std::abs(seen / *period - 1) <= 0.01) continue;
            log.notes.push_back(fmt::format("{}: axis {}: the set-points change every {:.4g} s, and "
                                            "drive.set_point_period_s is {:.4g}: the drive is taken to read "
                                            "every {} of them.",
                                            log.file, axis.name, seen, *period,
                                            *period > seen ? fmt::format("{:.3g}th", *period / seen)
                                                           : std::string("one more than once")));
        }
}

/// Refuses a log that cannot be of the machine described: bad_input.
inline void check_match(const machine_description& machine, const machine_log& log) {
    if (!has_period_of(machine, log))
        throw bad_input(log.file, fmt::format("the sample period is {:.6g} s, sample_period_s of {} is {:.6g}: "
                                              "correct that, or import the log with --sample-period {:.6g}",
                                              log.sample_period_s, machine.file, machine.sample_period_s,
                                              machine.sample_period_s));
    const auto named = [](const auto& axes, const std::string& name) {
        return std::find_if(axes.begin(), axes.end(), [&](const auto& axis) { return axis.name == name; });
    };
    for (const auto& axis : log.axes)
        if (named(machine.axes, axis.name) == machine.axes.end())
            throw bad_input(log.file, fmt::format("axis {} is not described in {}", axis.name, machine.file));
    for (const auto& axis : machine.axes) {
        const auto logged = named(log.axes, axis.name);
        if (logged == log.axes.end())
            throw bad_input(machine.file, fmt::format("axes.{}: is not recorded in {}", axis.name, log.file));
        if (logged->kind != axis.kind)
            throw bad_input(log.file, fmt::format("axis {} is {} in the log, {} in {}", axis.name,
                                                  name_of(logged->kind), name_of(axis.kind), machine.file));
        if (axis.positions_only) {
            detail::check_positions(axis, *logged, log.file);
            continue;
        }
        if (axis.drive.closes()) {
            detail::check_drive(axis, *logged, machine.file, log.file);
            continue;
        }
        if (logged->command_unit.empty())
            throw bad_input(log.file,
                            fmt::format("column {0}_cmd_V is missing (or {0}_cmd_A, {0}_cmd_{1}; measured: "
                                        "{0}_current_A{2}): without a command only an axis whose drive "
                                        "takes positions is diagnosed (axes.{0}.drive.kind)",
                                        axis.name, key_of("N", axis.kind),
                                        and_torque(", ", axis.name, axis.kind)));
        if (logged->command_unit == axis.command_unit) continue;
        if (logged->command_unit.starts_with(key_of("m", axis.kind)) || logged->command_unit == "duty")
            throw bad_input(
                machine.file,
                fmt::format("axes.{0}.drive.kind: is current (the default); the command column of {1} "
                            "is {0}_cmd_{2}, of a drive of kind {3}",
                            axis.name, log.file, logged->command_unit,
                            logged->command_unit == "duty"         ? "position_servo"
                            : logged->command_unit.ends_with("_s") ? "velocity"
                                                                   : "position"));
        const std::string column =
            fmt::format("the command column of {} is {}_cmd_{}", log.file, axis.name, logged->command_unit);
        const std::string constant = key_of("force_constant_N_per_", axis.kind);
        if (is_force(axis.command_unit))
            throw bad_input(machine.file, fmt::format("axes.{}.plant.{}{}: is missing; {}", axis.name, constant,
                                                      logged->command_unit, column));
        throw bad_input(machine.file,
                        fmt::format("axes.{}.plant.{}{}: {}", axis.name, constant, axis.command_unit, column));
    }
}

} // namespace quadrant::inline v0::diagnosis
