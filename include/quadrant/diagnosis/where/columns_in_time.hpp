// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/late_command.hpp"
#include "../machine/machine.hpp"
#include "column_shift.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace quadrant::inline v0::diagnosis {

/// An axis with what the names of its log's columns say of it.
inline axis_description as_logged(axis_description axis, const axis_log& log) {
    if (log.command_is == command_origin::measured) axis.actuator.command_is = command_origin::measured;
    return axis;
}

namespace detail {

/// The log and the hold-out log of one axis, and what was done to them.
struct columns_in_time {
    const axis_description& axis;
    double period;
    axis_log& log;
    std::optional<axis_log>& holdout;
    std::vector<std::string>& notes;

    void by_replay();
    void before_it_was_on();
    void by_motion();

private:
    template <class Change> void change(const Change& of) {
        log = of(std::move(log));
        if (holdout) holdout = of(std::move(*holdout));
    }
};

/// Columns that were not sampled with the position are read as the controller had them. A controller that
/// answers late, and whose command acts as late, is no matter of the log.
inline void columns_in_time::by_replay() {
    const auto found =
        shift_of_columns(*axis.controller, axis.actuator, log, period, axis.encoder.resolution_m);
    if (!found) return;
    const auto told = [](int rows) {
        return fmt::format("{} {} {}", std::abs(rows), std::abs(rows) == 1 ? "row" : "rows",
                           rows > 0 ? "later" : "earlier");
    };
    column_shift late = *found;
    if (late.command != 0) {
        const command_timing acts = timing_of_command(log, period, axis.plant);
        if (acts.of_plant && acts.spread < 0.25 * period && std::abs(acts.later) < 0.5 * period) {
            notes.push_back(fmt::format("axis {}: the controller that ran gives the command {} than the one "
                                        "described, and otherwise the same; nothing else is said of it.",
                                        axis.name, told(late.command)));
            late = {};
            change([](axis_log l) {
                l.as_sampled = false; // it is replayed no more
                return l;
            });
        }
    }
    const char* const why = "as the controller's replay says; it is read in time with the position.";
    if (late.command != 0)
        notes.push_back(fmt::format("axis {}: the command stands {} in the log than the position, {}",
                                    axis.name, told(late.command), why));
    if (late.reference != 0)
        notes.push_back(fmt::format("axis {}: the reference stands {} in the log than the position, {}",
                                    axis.name, told(late.reference), why));
    if (late.command == 0 && late.reference == 0) return;
    change([&](axis_log l) { return put_right(std::move(l), late); });
}

/// Rows at the beginning in which nothing is commanded, and the described controller would: it was off, or its
/// drive was.
inline void columns_in_time::before_it_was_on() {
    constexpr std::ptrdiff_t least = 32; // rows
    const auto& u = log.command;
    const auto on = std::find_if(u.begin(), u.end(), [](double x) { return x != 0; });
    if (on - u.begin() < least || on == u.end()) return;
    const auto rows = static_cast<std::size_t>(on - u.begin());
    const auto replayed =
        replay_controller(*axis.controller, axis.actuator, period,
                          loop_columns{log.reference, log.position, std::span(u)}.part(0, rows));
    const double step = std::max(dac_step(axis.actuator), log.command_step);
    if (!(rms(replayed) > step)) return;
    log.left_out.resize(log.position.size());
    std::fill(log.left_out.begin(), log.left_out.begin() + (on - u.begin()), 1);
    notes.push_back(fmt::format("axis {}: nothing is commanded up to {:.3g} s, where the described controller "
                                "would: it was off, or its drive was. These rows are left out.",
                                axis.name, period * static_cast<double>(rows)));
}

/// A command that was recorded late is read as it acted: else a mode or a lag stands in for it.
inline void columns_in_time::by_motion() {
    if (axis.actuator.command_is == command_origin::measured) {
        if (const auto low_pass = low_pass_of_command(log, period, axis.plant)) {
            notes.push_back(fmt::format("axis {}: the measured command was recorded late by {:.2g} ms, as "
                                        "behind a low-pass; it is read as it was before.",
                                        axis.name, 1e3 * low_pass->of_slope));
            return change([&](axis_log l) { return read_before_low_pass(std::move(l), *low_pass, period); });
        }
    }
    const double late = lateness_of_command(log, period, axis.plant, axis.actuator.command_is);
    if (late == 0) return;
    const bool between = axis.actuator.command_is == command_origin::measured && late == period / 2;
    notes.push_back(
        between ? fmt::format("axis {}: the loop that made this motion runs faster than the rows; the measured "
                              "command is taken to go from each row to the next in a line.",
                              axis.name)
        : late > 0
            ? fmt::format(
                  "axis {}: the command stands {:.2g} ms later in the log than {}; it is read as so much "
                  "earlier.",
                  axis.name, 1e3 * late,
                  axis.plant.delay_s > 0 ? "the machine file's delay lets it act" : "the motion that it makes")
            : fmt::format(
                  "axis {}: the motion stands {:.2g} ms later in the log than the measured command makes "
                  "it; the command is read as so much later.",
                  axis.name, -1e3 * late));
    change([&](axis_log l) { return read_earlier(std::move(l), late, period); });
}

} // namespace detail

/// Reads columns as the controller had them and as the command acted, where the log stands otherwise, and says
/// so.
inline void put_columns_in_time(const axis_description& axis, double period, axis_log& log,
                                std::optional<axis_log>& holdout, std::vector<std::string>& notes) {
    detail::columns_in_time all{axis, period, log, holdout, notes};
    if (axis.drive.closes()) return;
    if (axis.controller && log.has_reference && log.as_sampled && log.left_out.empty() &&
        axis.actuator.command_is == command_origin::asked) {
        all.by_replay();
        if (log.as_sampled) all.before_it_was_on();
    }
    all.by_motion();
}

} // namespace quadrant::inline v0::diagnosis
