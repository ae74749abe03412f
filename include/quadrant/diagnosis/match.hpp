// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "bad_input.hpp"
#include "log.hpp"
#include "machine.hpp"

#include <algorithm>
#include <cmath>

namespace quadrant::diagnosis {

/// Whether a log has the sample period of the machine file, to a hundredth.
inline bool has_period_of(const machine_description& machine, const machine_log& log) {
    constexpr double allowed = 0.01;
    return std::abs(log.sample_period_s / machine.sample_period_s - 1) <= allowed;
}

/// Refuses a log that cannot be of the machine described: bad_input.
inline void check_match(const machine_description& machine, const machine_log& log) {
    if (!has_period_of(machine, log))
        throw bad_input(log.file, fmt::format("the sample period is {:.6g} s, sample_period_s of {} is {:.6g}",
                                              log.sample_period_s, machine.file, machine.sample_period_s));
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
        if (logged->command_unit == axis.command_unit) continue;
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

} // namespace quadrant::diagnosis
