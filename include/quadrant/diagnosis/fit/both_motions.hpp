// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "with_drives.hpp"

#include <numbers>
#include <optional>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Rows between two logs in which the position goes from the end of the one to the start of the other, smoothly
/// and slowly beside what is logged: a tenth of the shorter log.
inline std::size_t rows_between(const axis_log& first, const axis_log& second) {
    return std::max<std::size_t>(2, std::min(first.position.size(), second.position.size()) / 10);
}

/// Two columns one behind the other, joined by `between` rows of smooth motion; empty where one has none.
inline std::vector<double> column_of_both(const std::vector<double>& first, const std::vector<double>& second,
                                          std::size_t between) {
    if (first.empty() || second.empty()) return {};
    std::vector<double> out = first;
    const double from = first.back(), to = second.front();
    for (std::size_t k = 1; k <= between; ++k) {
        const double part = static_cast<double>(k) / static_cast<double>(between + 1);
        out.push_back(from + (to - from) * (1 - std::cos(std::numbers::pi * part)) / 2);
    }
    out.insert(out.end(), second.begin(), second.end());
    return out;
}
/// Marks of rows, `marked` those between; empty where nothing is marked.
inline std::vector<unsigned char> marks_of_both(const std::vector<unsigned char>& first, std::size_t first_rows,
                                                const std::vector<unsigned char>& second,
                                                std::size_t second_rows, std::size_t between, bool marked) {
    if (first.empty() && second.empty() && !marked) return {};
    std::vector<unsigned char> out = first;
    out.resize(first_rows, 0);
    out.resize(first_rows + between, marked ? 1 : 0);
    out.insert(out.end(), second.begin(), second.end());
    out.resize(first_rows + between + second_rows, 0);
    return out;
}

} // namespace detail

/// Two logs of a drive that closes its loops, as read, in one record: for models whose path is judged. There
/// the second begins anew; the rows between are no motion of the machine and say nothing. None where the logs
/// do not hold the same columns.
inline std::optional<axis_log> both_motions(const axis_description& axis, const axis_log& first,
                                            const axis_log& second, double period) {
    const auto same = [&](auto column) { return (first.*column).empty() == (second.*column).empty(); };
    if (!same(&axis_log::command) || !same(&axis_log::duty) || !same(&axis_log::effort) ||
        first.command_unit != second.command_unit || first.effort_unit != second.effort_unit ||
        first.command_is != second.command_is || first.has_reference != second.has_reference ||
        second.position.size() < 3)
        return {};
    const std::size_t between = detail::rows_between(first, second), n = first.position.size(),
                      m = second.position.size();
    axis_log out = first;
    for (auto column :
         {&axis_log::position, &axis_log::reference, &axis_log::command, &axis_log::duty, &axis_log::effort,
          &axis_log::motor, &axis_log::velocity, &axis_log::reference_velocity,
          &axis_log::reference_acceleration, &axis_log::other_acceleration, &axis_log::controller_reads})
        out.*column = detail::column_of_both(first.*column, second.*column, between);
    out.left_out = detail::marks_of_both(first.left_out, n, second.left_out, m, between, true);
    out.drive_off = detail::marks_of_both(first.drive_off, n, second.drive_off, m, between, false);
    for (auto step : {&axis_log::position_step, &axis_log::reference_step, &axis_log::command_step,
                      &axis_log::duty_step, &axis_log::effort_step})
        out.*step = std::max(first.*step, second.*step);
    out.as_sampled = first.as_sampled && second.as_sampled;
    out.least_give = std::max(first.least_give, second.least_give);
    out = detail::with_drive(axis, out, period);
    auto motion = std::make_shared<driven_motion>(*out.drive);
    motion->begins.push_back({n + between, (second.position[2] - second.position[0]) / (2 * period)});
    out.drive = std::move(motion);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
