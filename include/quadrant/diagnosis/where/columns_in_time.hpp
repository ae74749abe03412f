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

namespace detail {

/// The log and the hold-out log of one axis, and what was done to them.
struct columns_in_time {
    const axis_description& axis;
    double period;
    axis_log& log;
    std::optional<axis_log>& holdout;
    std::vector<std::string>& notes;

    void by_replay();
    void by_motion();

private:
    template <class Change> void change(const Change& of) {
        log = of(std::move(log));
        if (holdout) holdout = of(std::move(*holdout));
    }
};

/// Columns that were not sampled with the position are read as the controller had them. A controller that answers
/// late, and whose command acts as late, is no matter of the log.
inline void columns_in_time::by_replay() {
    if (!axis.controller || !log.has_reference || !log.as_sampled || !log.left_out.empty() ||
        axis.actuator.command_is == command_origin::measured)
        return;
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

/// A command that was recorded late is read as it acted: else a mode or a lag stands in for it.
inline void columns_in_time::by_motion() {
    const double late = lateness_of_command(log, period, axis.plant, axis.actuator.command_is);
    if (late == 0) return;
    notes.push_back(
        late > 0
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
    all.by_replay();
    all.by_motion();
}

} // namespace quadrant::inline v0::diagnosis
