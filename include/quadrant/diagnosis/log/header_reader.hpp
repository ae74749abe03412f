// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/csv_cells.hpp"
#include "log_header.hpp"

#include <set>
#include <utility>

namespace quadrant::inline v0::diagnosis::detail {

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
    if (c.suffix->role == column_role::torque && axis.kind == axis_kind::linear) {
        out.notes.push_back(fmt::format(
            "column {} is not used: axis {} is linear; log the motor's current ({}_current_A), which "
            "plant.force_constant_N_per_A turns into force",
            in_quotes(column.name), found->first, found->first));
        return;
    }
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

/// Reads the line of column names. `refuse(offset, message)` throws. Of a motion only the reference is read.
template <class Refuse> class header_reader {
public:
    header_reader(std::string_view line, Refuse refuse, log_purpose purpose)
        : line_(line), refuse_(refuse), purpose_(purpose), cells_(line) {}

    log_header read() {
        refuse_other_files();
        while (cells_.next()) take_column();
        if (!time_) refuse_(line_.size(), "column t_s is missing");
        if (out_.axes.empty())
            refuse_(line_.size(), "no axis: columns such as x_ref_m, x_pos_m and x_cmd_V are missing");
        for (auto& [name, axis] : out_.axes)
            if (!axis.kind) axis.kind = axis.command_unit == "Nm" ? axis_kind::rotary : axis_kind::linear;
        for (const column_beside& c : beside_) join_beside(out_, c, purpose_, refuse_);
        for (const auto& [name, axis] : out_.axes) check(name, axis);
        out_.time = *time_;
        return std::move(out_);
    }

private:
    void refuse_other_files() {
        for (const std::string_view mark : {"MATLAB ", "PAR1", "\x89HDF"})
            if (line_.starts_with(mark))
                refuse_(0, "is a MAT, Parquet or HDF5 file: make a log of it with quadrant-gap import FILE "
                           "log.csv");
        if (line_.find('\0') != line_.npos)
            refuse_(line_.find('\0'),
                    "holds zero bytes: it is UTF-16 without a byte order mark, or no text; save it as "
                    "UTF-8");
        if (line_.starts_with('{')) refuse_(0, "is JSON and no log: is it the machine file?");
        if (line_.find('\r') != line_.npos)
            refuse_(line_.find('\r'), "lines end with carriage returns alone: save it with line feeds");
        if (const auto other = line_.find_first_of(";\t"); other != line_.npos && line_.find(',') == line_.npos)
            refuse_(other,
                    "cells must be separated by commas: bring the file in with quadrant-gap import (with --map "
                    "where its columns have other names)");
    }
    void take_column() {
        if (cells_.broken())
            refuse_(cells_.offset(), "a quote is not closed before the comma or the end of the line");
        const std::string_view name = cells_.text();
        const std::size_t index = out_.columns.size();
        if (double number = 0; index == 0 && !parse_number(name, number))
            refuse_(cells_.offset(), "the first line must name the columns (t_s, x_ref_m, ...)");
        if (!name.empty() && !seen_.insert(name).second)
            refuse_(cells_.offset(), fmt::format("column {} is there twice", in_quotes(name)));
        out_.columns.push_back({.name = std::string(name)});
        if (name == "t_s") {
            time_ = index;
            out_.columns.back().used = true;
            return;
        }
        const auto suffix =
            std::find_if(column_suffixes.begin(), column_suffixes.end(), [&](const column_suffix& s) {
                return name.size() > s.text.size() && name.ends_with(s.text);
            });
        if (suffix == column_suffixes.end())
            out_.notes.push_back(
                fmt::format("column {} is not part of the format and is ignored", in_quotes(name)));
        else if (suffix->role == column_role::not_used_yet)
            out_.notes.push_back(fmt::format("column {} is not used by this version", in_quotes(name)));
        else if (is_beside(suffix->role))
            beside_.push_back({index, cells_.offset(), &*suffix});
        else if (purpose_ == log_purpose::record || suffix->role == column_role::reference)
            join_axis(*suffix, index);
    }
    /// Reference, position or command: what makes an axis.
    void join_axis(const column_suffix& suffix, std::size_t index) {
        const std::string_view name = cells_.text();
        const std::string axis_name(name.substr(0, name.size() - suffix.text.size()));
        if (!is_axis_name(axis_name))
            refuse_(cells_.offset(),
                    fmt::format("{}: an axis is named by letters, digits, _ and -", in_quotes(name)));
        auto& axis = out_.axes[axis_name];
        if (suffix.role == column_role::command && axis.command)
            refuse_(cells_.offset(), fmt::format("axis {} has two commands: {} and {}", axis_name,
                                                 out_.columns[*axis.command].name, name));
        if (suffix.role != column_role::command) {
            const axis_kind kind = suffix.unit == "rad" ? axis_kind::rotary : axis_kind::linear;
            if (axis.kind.value_or(kind) != kind)
                refuse_(cells_.offset(),
                        fmt::format("{}: axis {} is linear (m, N) or rotary (rad, Nm), not both",
                                    in_quotes(name), axis_name));
            axis.kind = kind;
        }
        (suffix.role == column_role::reference  ? axis.reference
         : suffix.role == column_role::position ? axis.position
                                                : axis.command) = index;
        if (suffix.role == column_role::command) {
            axis.command_unit = suffix.unit;
            axis.command_at = cells_.offset();
        }
        out_.columns[index].used = true;
    }
    /// An axis has the columns that it needs, and a command of its kind.
    template <class Axis> void check(const std::string& name, const Axis& axis) {
        const std::string m = key_of("m", *axis.kind), force = key_of("N", *axis.kind);
        if (purpose_ == log_purpose::motion) {
            if (!axis.reference) refuse_(line_.size(), fmt::format("column {}_ref_{} is missing", name, m));
            return;
        }
        if (!axis.position) refuse_(line_.size(), fmt::format("column {}_pos_{} is missing", name, m));
        // A position beside other axes says something of those: check_match() asks for the rest.
        if (!axis.command && !axis.reference && !axis.motor && out_.axes.size() == 1)
            refuse_(line_.size(),
                    fmt::format(
                        "column {0}_cmd_V is missing (or {0}_cmd_A, {0}_cmd_{1}; measured: {0}_current_A{3}; "
                        "of a drive that takes positions: {0}_ref_{2})",
                        name, force, m, and_torque(", ", name, *axis.kind)));
        if (const auto kind = kind_of_unit(axis.command_unit); kind && *kind != *axis.kind)
            refuse_(axis.command_at, fmt::format("column {}_cmd_{} belongs to a {} axis; axis {} is {}", name,
                                                 axis.command_unit, name_of(*kind), name, name_of(*axis.kind)));
        if (is_force(axis.command_unit) && axis.command_unit != force)
            refuse_(axis.command_at, fmt::format("axis {0} is {1}: its command is {0}_cmd_V, {0}_cmd_A or "
                                                 "{0}_cmd_{2}",
                                                 name, name_of(*axis.kind), force));
    }

    std::string_view line_;
    Refuse refuse_;
    log_purpose purpose_;
    csv_cells cells_;
    log_header out_;
    std::set<std::string_view> seen_;
    std::optional<std::size_t> time_;
    std::vector<column_beside> beside_; ///< joined when it is known which axes there are
};

template <class Refuse>
log_header read_header(std::string_view line, Refuse refuse, log_purpose purpose = log_purpose::record) {
    return header_reader<Refuse>(line, refuse, purpose).read();
}

} // namespace quadrant::inline v0::diagnosis::detail
