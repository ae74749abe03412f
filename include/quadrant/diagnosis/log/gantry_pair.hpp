// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "../text/bad_input.hpp"
#include "log.hpp"

#include <fmt/format.h>

/// Two motors on one beam: what the log has of its ends, as the axes that the machine file describes.
namespace quadrant::inline v0::diagnosis {

namespace detail {

/// of_first x + of_second y in each row; empty where one of the two columns is not there.
inline std::vector<double> weighted(double of_first, const std::vector<double>& x, double of_second,
                                    const std::vector<double>& y) {
    if (x.size() != y.size()) return {};
    std::vector<double> out(x.size());
    for (std::size_t k = 0; k < x.size(); ++k) out[k] = of_first * x[k] + of_second * y[k];
    return out;
}

/// Marks in `rows` what is marked in `others`; either may be empty, with nothing marked.
template <class Marks> void mark_too(Marks& rows, const Marks& others) {
    if (rows.size() < others.size()) rows.resize(others.size(), 0);
    for (std::size_t k = 0; k < others.size(); ++k) rows[k] |= others[k];
}

/// The motion of the beam: its centre of gravity under both forces. Behind drives with loops of their own,
/// whose commands are velocities or positions, under the mean of those.
inline axis_log moved_beam(const axis_description& axis, const axis_log& first, const axis_log& second) {
    const gantry_description& g = *axis.gantry_pair;
    const double a = g.share, b = 1 - g.share;
    const bool driven = axis.drive.closes();
    axis_log out = first;
    out.name = axis.name;
    out.still = first.still && second.still;
    out.has_reference = first.has_reference && second.has_reference;
    out.position = weighted(a, first.position, b, second.position);
    out.reference = out.has_reference ? weighted(a, first.reference, b, second.reference) : out.position;
    out.command =
        driven ? weighted(a, first.command, b, second.command) : weighted(1, first.command, 1, second.command);
    out.reference_velocity = weighted(a, first.reference_velocity, b, second.reference_velocity);
    out.reference_acceleration = weighted(a, first.reference_acceleration, b, second.reference_acceleration);
    out.velocity = weighted(a, first.velocity, b, second.velocity);
    out.effort = weighted(1, first.effort, 1, second.effort);
    out.duty = weighted(a, first.duty, b, second.duty);
    out.motor =
        first.motor_unit == second.motor_unit ? weighted(a, first.motor, b, second.motor)
                                              : std::vector<double>{};
    for (auto member : {&axis_log::reference_step, &axis_log::position_step, &axis_log::command_step,
                        &axis_log::duty_step, &axis_log::effort_step, &axis_log::motor_step})
        out.*member = std::max(first.*member, second.*member);
    for (auto member : {&axis_log::left_out, &axis_log::drive_off}) mark_too(out.*member, second.*member);
    out.as_sampled = first.as_sampled && second.as_sampled;
    const bool forces = !driven && !first.command_unit.empty();
    out.turn = std::make_shared<const beam_turn>(beam_turn{
        g.first, g.second, a, forces ? weighted(b, first.command, -a, second.command) : std::vector<double>{}});
    return out;
}

/// The readings of both ends, one behind the other.
inline axis_log two_ends(const axis_description& axis, const axis_log& first, const axis_log& second) {
    axis_log out;
    out.name = axis.name;
    out.still = first.still && second.still;
    out.kind = axis.kind;
    out.command_unit.clear();
    out.has_reference = false;
    out.position = out.reference = second.position;
    out.command.assign(out.position.size(), 0.0);
    out.position_step = second.position_step;
    out.motor = first.position;
    out.motor_unit = "m"; // in units of the other end
    out.motor_step = first.position_step;
    out.left_out = first.left_out;
    mark_too(out.left_out, second.left_out);
    out.as_sampled = first.as_sampled && second.as_sampled;
    out.turn =
        std::make_shared<const beam_turn>(beam_turn{first.name, second.name, axis.gantry_pair->share, {}});
    return out;
}

} // namespace detail

/// Puts the axes of each described gantry (axes.<a>.gantry_pair) in the place of its two ends, which the log
/// has as axes of their own: bad_input where one is missing, or where the two are of different kinds or units.
inline void join_gantry_pairs(const machine_description& machine, machine_log& log) {
    const auto end = [&](const axis_description& axis, const std::string& name) -> const axis_log& {
        const auto found =
            std::find_if(log.axes.begin(), log.axes.end(), [&](const axis_log& a) { return a.name == name; });
        if (found == log.axes.end())
            throw bad_input(log.file, fmt::format("axis {0}: column {1}_pos_{2} is missing: {1} is an end of "
                                                  "axes.{0}.gantry_pair in {3}",
                                                  axis.name, name, key_of("m", axis.kind), machine.file));
        return *found;
    };
    std::vector<axis_log> joined;
    std::vector<std::string> ends;
    for (const axis_description& axis : machine.axes) {
        if (!axis.gantry_pair) continue;
        const bool there = std::any_of(log.axes.begin(), log.axes.end(),
                                       [&](const axis_log& a) { return a.name == axis.name && a.turn; });
        if (there) continue; // joined already
        const axis_log &first = end(axis, axis.gantry_pair->first),
                       &second = end(axis, axis.gantry_pair->second);
        const auto refuse = [&](const char* what, std::string_view a, std::string_view b) {
            throw bad_input(log.file, fmt::format("axis {}: its two ends have {}: {} of {}, {} of {}",
                                                  axis.name, what, a, first.name, b, second.name));
        };
        if (first.kind != second.kind) refuse("different kinds", name_of(first.kind), name_of(second.kind));
        if (!axis.positions_only && first.command_unit != second.command_unit)
            refuse("commands of different units", first.command_unit.empty() ? "none" : first.command_unit,
                   second.command_unit.empty() ? "none" : second.command_unit);
        joined.push_back(axis.positions_only ? detail::two_ends(axis, first, second)
                                             : detail::moved_beam(axis, first, second));
        ends.push_back(first.name);
        ends.push_back(second.name);
    }
    if (joined.empty()) return;
    const auto described = [&](const std::string& name) {
        return std::any_of(machine.axes.begin(), machine.axes.end(),
                           [&](const axis_description& a) { return a.name == name; });
    };
    std::erase_if(log.axes, [&](const axis_log& a) {
        return std::find(ends.begin(), ends.end(), a.name) != ends.end() && !described(a.name);
    });
    for (axis_log& a : joined) {
        std::erase_if(log.axes, [&](const axis_log& old) { return old.name == a.name; });
        log.axes.push_back(std::move(a));
    }
    std::sort(log.axes.begin(), log.axes.end(),
              [](const axis_log& a, const axis_log& b) { return a.name < b.name; });
}

} // namespace quadrant::inline v0::diagnosis
