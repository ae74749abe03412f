// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/axis_name.hpp"
#include "../text/axis_words.hpp"
#include "../text/csv_cells.hpp"
#include "../text/decimal.hpp"
#include "../text/text.hpp"

#include <map>
#include <optional>
#include <set>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

struct log_column {
    std::string name;
    bool used = false;
    std::vector<double> values{};
    written_step step{};
};

/// Which column is what.
struct log_header {
    struct axis_columns {
        std::optional<std::size_t> reference, position, command;
        std::optional<std::size_t> enabled; ///< 0 where the drive is off
        std::optional<std::size_t> duty,
            effort; ///< of the drive's bridge; measured behind it, beside a command
        std::string effort_unit;
        std::optional<std::size_t> motor; ///< a second encoder
        std::string motor_unit;
        bool command_measured = false; ///< it was taken behind the amplifier
        std::optional<std::size_t> reference_velocity, reference_acceleration, velocity; ///< need not be there
        std::string command_unit;
        std::size_t command_at = 0; ///< in the header line
        std::optional<axis_kind> kind;
    };
    std::vector<log_column> columns;
    std::size_t time = 0;
    std::map<std::string, axis_columns> axes;
    std::vector<std::string> notes;
};

enum class column_role {
    reference,
    position,
    command,
    reference_velocity,
    reference_acceleration,
    velocity,
    current,
    torque,
    duty,
    enabled,
    motor_position,
    not_used_yet
};

struct column_suffix {
    std::string_view text;
    column_role role;
    std::string_view unit = {};
};
inline constexpr std::array column_suffixes{
    column_suffix{"_motor_pos_m", column_role::motor_position, "m"},
    column_suffix{"_motor_pos_rad", column_role::motor_position, "rad"},
    column_suffix{"_ref_m", column_role::reference, "m"},
    column_suffix{"_pos_m", column_role::position, "m"},
    column_suffix{"_ref_rad", column_role::reference, "rad"},
    column_suffix{"_pos_rad", column_role::position, "rad"},
    column_suffix{"_cmd_V", column_role::command, "V"},
    column_suffix{"_cmd_A", column_role::command, "A"},
    column_suffix{"_cmd_N", column_role::command, "N"},
    column_suffix{"_cmd_Nm", column_role::command, "Nm"},
    column_suffix{"_cmd_m_per_s", column_role::command, "m_per_s"},
    column_suffix{"_cmd_rad_per_s", column_role::command, "rad_per_s"},
    column_suffix{"_cmd_m", column_role::command, "m"},
    column_suffix{"_cmd_rad", column_role::command, "rad"},
    column_suffix{"_cmd_duty", column_role::command, "duty"},
    column_suffix{"_ref_m_per_s", column_role::reference_velocity, "m"},
    column_suffix{"_ref_m_per_s2", column_role::reference_acceleration, "m"},
    column_suffix{"_vel_m_per_s", column_role::velocity, "m"},
    column_suffix{"_ref_rad_per_s", column_role::reference_velocity, "rad"},
    column_suffix{"_ref_rad_per_s2", column_role::reference_acceleration, "rad"},
    column_suffix{"_vel_rad_per_s", column_role::velocity, "rad"},
    column_suffix{"_acc_m_per_s2", column_role::not_used_yet},
    column_suffix{"_force_N", column_role::not_used_yet},
    column_suffix{"_acc_rad_per_s2", column_role::not_used_yet},
    column_suffix{"_current_A", column_role::current, "A"},
    column_suffix{"_torque_Nm", column_role::torque, "Nm"},
    column_suffix{"_enabled", column_role::enabled},
    column_suffix{"_duty", column_role::duty},
    column_suffix{"_supply_V", column_role::not_used_yet},
};

/// The units of a command that only a drive with loops of its own takes, those of one kind of axis among them.
constexpr std::optional<axis_kind> kind_of_unit(std::string_view unit) {
    if (unit == "m" || unit == "m_per_s") return axis_kind::linear;
    if (unit == "rad" || unit == "rad_per_s") return axis_kind::rotary;
    return {};
}

/// Columns that say more of an axis that others make: they come behind those.
constexpr bool is_beside(column_role r) {
    return r != column_role::reference && r != column_role::position && r != column_role::command;
}

/// What a file is read for: what a machine did, or a motion that it is to make.
enum class log_purpose { record, motion };

/// A column of an axis that others make.
struct column_beside {
    std::size_t index, offset;
    const column_suffix* suffix;
};

/// Joins such a column to its axis. A measured current or torque is the command of an axis that has none.
template <class Refuse>
void join_beside(log_header& out, const column_beside& c, log_purpose purpose, Refuse refuse) {
    log_column& column = out.columns[c.index];
    const auto found = out.axes.find(column.name.substr(0, column.name.size() - c.suffix->text.size()));
    if (found == out.axes.end()) {
        out.notes.push_back(
            fmt::format("column {} belongs to no axis of the log and is ignored", in_quotes(column.name)));
        return;
    }
    auto& axis = found->second;
    const bool motion = c.suffix->role == column_role::velocity ||
                        c.suffix->role == column_role::reference_velocity ||
                        c.suffix->role == column_role::reference_acceleration;
    if (motion && (c.suffix->unit == "rad") != (axis.kind == axis_kind::rotary))
        refuse(c.offset,
               fmt::format("{}: axis {} is {}", in_quotes(column.name), found->first, name_of(*axis.kind)));
    if (purpose == log_purpose::motion &&
        (!motion || c.suffix->role == column_role::velocity)) // what a machine did, not what it is to do
        return;
    const bool measured = c.suffix->role == column_role::current || c.suffix->role == column_role::torque;
    column.used = true;
    if (measured && axis.command) {
        axis.effort = c.index;
        axis.effort_unit = c.suffix->unit;
        return;
    }
    if (measured) {
        axis.command = c.index;
        axis.command_unit = c.suffix->unit;
        axis.command_at = c.offset;
        axis.command_measured = true;
        return;
    }
    if (c.suffix->role == column_role::motor_position) {
        if (axis.motor)
            refuse(c.offset, fmt::format("axis {} has two motor encoders: {} and {}", found->first,
                                         out.columns[*axis.motor].name, column.name));
        if (c.suffix->unit == "m" && axis.kind == axis_kind::rotary)
            refuse(c.offset, fmt::format("{}: axis {} is rotary", in_quotes(column.name), found->first));
        axis.motor = c.index;
        axis.motor_unit = c.suffix->unit;
        return;
    }
    (c.suffix->role == column_role::velocity             ? axis.velocity
     : c.suffix->role == column_role::reference_velocity ? axis.reference_velocity
     : c.suffix->role == column_role::enabled            ? axis.enabled
     : c.suffix->role == column_role::duty               ? axis.duty
                                                         : axis.reference_acceleration) = c.index;
}

/// `refuse(offset, message)` throws. Of a motion only the reference is read.
template <class Refuse>
log_header read_header(std::string_view line, Refuse refuse, log_purpose purpose = log_purpose::record) {
    if (line.find('\0') != line.npos)
        refuse(line.find('\0'),
               "holds zero bytes: it is UTF-16 without a byte order mark, or no text; save it as "
               "UTF-8");
    if (const auto other = line.find_first_of(";\t"); other != line.npos && line.find(',') == line.npos)
        refuse(other,
               "cells must be separated by commas: bring the file in with quadrant-gap import (with --map "
               "where its columns have other names)");
    log_header out;
    std::set<std::string_view> seen;
    std::optional<std::size_t> time;
    csv_cells cells(line);
    const auto join_axis = [&](const column_suffix& suffix, std::size_t index) {
        const std::string_view name = cells.text();
        const std::string axis_name(name.substr(0, name.size() - suffix.text.size()));
        if (!is_axis_name(axis_name))
            refuse(cells.offset(),
                   fmt::format("{}: an axis is named by letters, digits, _ and -", in_quotes(name)));
        auto& axis = out.axes[axis_name];
        if (suffix.role == column_role::command && axis.command)
            refuse(cells.offset(), fmt::format("axis {} has two commands: {} and {}", axis_name,
                                               out.columns[*axis.command].name, name));
        if (suffix.role != column_role::command) {
            const axis_kind kind = suffix.unit == "rad" ? axis_kind::rotary : axis_kind::linear;
            if (axis.kind.value_or(kind) != kind)
                refuse(cells.offset(), fmt::format("{}: axis {} is linear (m, N) or rotary (rad, Nm), not both",
                                                   in_quotes(name), axis_name));
            axis.kind = kind;
        }
        (suffix.role == column_role::reference  ? axis.reference
         : suffix.role == column_role::position ? axis.position
                                                : axis.command) = index;
        if (suffix.role == column_role::command) {
            axis.command_unit = suffix.unit;
            axis.command_at = cells.offset();
        }
        out.columns[index].used = true;
    };

    std::vector<column_beside> beside; ///< joined when it is known which axes there are
    while (cells.next()) {
        if (cells.broken())
            refuse(cells.offset(), "a quote is not closed before the comma or the end of the line");
        const std::string_view name = cells.text();
        const std::size_t index = out.columns.size();
        if (double number = 0; index == 0 && !parse_number(name, number))
            refuse(cells.offset(), "the first line must name the columns (t_s, x_ref_m, ...)");
        if (!name.empty() && !seen.insert(name).second)
            refuse(cells.offset(), fmt::format("column {} is there twice", in_quotes(name)));
        out.columns.push_back({.name = std::string(name)});
        if (name == "t_s") {
            time = index;
            out.columns.back().used = true;
            continue;
        }
        const auto suffix =
            std::find_if(column_suffixes.begin(), column_suffixes.end(), [&](const column_suffix& s) {
                return name.size() > s.text.size() && name.ends_with(s.text);
            });
        if (suffix == column_suffixes.end())
            out.notes.push_back(
                fmt::format("column {} is not one of the format's and is ignored", in_quotes(name)));
        else if (suffix->role == column_role::not_used_yet)
            out.notes.push_back(fmt::format("column {} is not used by this version", in_quotes(name)));
        else if (is_beside(suffix->role))
            beside.push_back({index, cells.offset(), &*suffix});
        else if (purpose == log_purpose::record || suffix->role == column_role::reference)
            join_axis(*suffix, index);
    }

    if (!time) refuse(line.size(), "column t_s is missing");
    if (out.axes.empty())
        refuse(line.size(), "no axis: columns such as x_ref_m, x_pos_m and x_cmd_V are missing");
    for (auto& [name, axis] : out.axes)
        if (!axis.kind) axis.kind = axis.command_unit == "Nm" ? axis_kind::rotary : axis_kind::linear;
    for (const column_beside& c : beside) join_beside(out, c, purpose, refuse);
    for (auto& [name, axis] : out.axes) {
        const std::string m = key_of("m", *axis.kind), force = key_of("N", *axis.kind);
        if (purpose == log_purpose::motion) {
            if (!axis.reference) refuse(line.size(), fmt::format("column {}_ref_{} is missing", name, m));
            continue;
        }
        if (!axis.position) refuse(line.size(), fmt::format("column {}_pos_{} is missing", name, m));
        if (!axis.command && !axis.reference && !axis.motor)
            refuse(
                line.size(),
                fmt::format("column {0}_cmd_V is missing (or {0}_cmd_A, {0}_cmd_{1}; measured: {0}_current_A, "
                            "{0}_torque_Nm)",
                            name, force));
        if (const auto kind = kind_of_unit(axis.command_unit); kind && *kind != *axis.kind)
            refuse(axis.command_at, fmt::format("column {}_cmd_{} is of a {} axis; axis {} is {}", name,
                                                axis.command_unit, name_of(*kind), name, name_of(*axis.kind)));
        if (is_force(axis.command_unit) && axis.command_unit != force)
            refuse(axis.command_at, fmt::format("axis {0} is {1}: its command is {0}_cmd_V, {0}_cmd_A or "
                                                "{0}_cmd_{2}",
                                                name, name_of(*axis.kind), force));
    }
    out.time = *time;
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
