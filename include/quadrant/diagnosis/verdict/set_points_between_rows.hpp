// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/set_point_rows.hpp"
#include "looked_axis.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string>
#include <utility>

namespace quadrant::inline v0::diagnosis::detail {

/// As many set-points in a row as are tried: how many they are and how late they are used is one number for the
/// log, so that the delay that is described decides.
inline constexpr std::array<double, 3> tried_in_a_row{set_points_in_a_row, 4, 2};

/// Whether the record fits better beside a drive that goes on between the rows. A log that is slower than the
/// controller shows one set-point of several: one that is held for a row is half a row late, and no described
/// delay is negative. As well is not better: a lighter mass behind a P loop answers as early.
inline bool asks_for_more_set_points(const looked_axis& looked, const axis_log& logged, const rules& r) {
    const axis_case& found = *looked.found;
    if (!logged.drive || !may_come_between_rows(looked.ready->axis.drive, logged.drive->set_point) ||
        found.models.over() || found.models.cut() || (found.settled && found.best().effects.empty()))
        return false;
    constexpr int steps = 30; // of a fit
    const fitter fit(found.record.observer, found.record.score);
    const auto score = [&](const fit_result& f) { return -fit.score_ms(f.ms); };
    const double enough = score(found.best().fit) + r.margin;
    return std::any_of(tried_in_a_row.begin(), tried_in_a_row.end(), [&](double in_a_row) {
        const auto with_more = [&](const candidate& c) {
            plant_model plant = c.fit.plant;
            plant.drive.set_point_period = found.record.period / in_a_row;
            return score(fit.fit(plant, resumed(c.fit), steps));
        };
        return with_more(found.path.front()) > enough || with_more(found.best()) > enough;
    });
}

/// The axis looked at with so many set-points in each row.
inline looked_axis looked_at_between_rows(const axis_description& described, double in_a_row,
                                          const read_logs& logs, const progress& tell, const rules& all,
                                          const rules& limits) {
    tell(fmt::format("axis {}: again, with {:g} set-points in a row", described.name, in_a_row));
    machine_description more = logs.machine;
    for (axis_description& axis : more.axes)
        if (axis.name == described.name) {
            axis.drive.set_point_period_s = more.sample_period_s / in_a_row;
            axis.drive.set_point_period_guessed = true;
        }
    const read_logs with_more(more, logs.as_read, logs.as_read_too);
    looked_axis out(*named(more.axes, described.name), *named(with_more.log.axes, described.name), with_more,
                    all);
    out.look(with_more, tell, limits);
    out.notes.push_back(fmt::format(
        "axis {0}: its drive is taken to get {1:g} set-points in each row of the log: the record fits better "
        "so than with one. If the controller is faster than the log, write its period as "
        "axes.{0}.drive.set_point_period_s. A velocity that the drive measures late looks alike: then write "
        "drive.velocity_filter_Hz.",
        described.name, in_a_row));
    return out;
}

/// Looks at the axis once more with set-points between the rows, where that fits better, and says so.
inline void look_between_rows(looked_axis& looked, const axis_description& described, const axis_log& logged,
                              const read_logs& logs, const progress& tell, const rules& all,
                              const rules& limits) {
    if (!asks_for_more_set_points(looked, logged, limits)) return;
    const auto worth = [&](const looked_axis& l) {
        const candidate& best = l.found->best();
        return best.total - limits.margin * static_cast<double>(best.effects.size());
    };
    const double enough = looked.found->best().total + limits.margin;
    const other_axes others = looked.ready->others; // those of the logs that stay
    for (const double in_a_row : tried_in_a_row) {
        looked_axis again = looked_at_between_rows(described, in_a_row, logs, tell, all, limits);
        if (again.found->models.cut() || !(again.found->best().total > enough) ||
            !(worth(again) > worth(looked)))
            continue;
        again.ready->others.logs = others.logs;
        looked = std::move(again);
        if (looked.found->settled && looked.found->best().effects.empty()) return;
    }
}

} // namespace quadrant::inline v0::diagnosis::detail
