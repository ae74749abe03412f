// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/late_command.hpp"
#include "../fit/with_drives.hpp"
#include "../result/result.hpp"
#include "axis_case.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Whether the force of a described velocity loop comes and goes between two rows, and nothing measured shows
/// it.
inline bool answers_between_rows(const axis_description& a, const axis_log& log, double period) {
    return !shows_the_force(a, log) && a.answer_of_loop() < period;
}

/// How uncertain the moment is at which the force of a row acts [s]: half of a row at most, between a command
/// that is held until the next row and one that goes there in a line. What the motion says of it is known to
/// twice its standard deviation.
inline double doubt_of_time(const axis_case& c) {
    const command_timing t = timing_of_command(c.log, c.record.period, c.axis.plant);
    const double half = c.record.period / 2;
    return t.of_plant && std::isfinite(t.spread) ? std::min(half, std::abs(t.later) + 2 * t.spread) : half;
}

/// Whether an effect does no more than what a measured command does between its rows: less than a line from row
/// to row is wrong by, or, in most of its energy, what the same command does at another time within the row.
/// Damping takes a torque half a row late for a mass.
inline bool may_act_between_rows(const axis_case& c, const effect& e) {
    if (c.axis.actuator.command_is != command_origin::measured || c.axis.drive.closes()) return false;
    const axis_record& r = c.record;
    auto slope = derivative(zero_phase(r.command, r.bandwidth_Hz, r.period), r.period);
    for (double& u : slope) u *= c.best().fit.plant.force_constant;
    const auto does = c.models.does(c.best(), e);
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    const double all = product(does, does), of_slope = product(slope, slope), of_both = product(does, slope);
    if (!(of_slope > 0)) return false;
    if (rms(does) < square(r.period) / 12 * rms(derivative(slope, r.period))) return true;
    const auto is_most = [&](double doubt) { // of the time [s]
        const double time = std::clamp(of_both / of_slope, -doubt, doubt);
        return time * (2 * of_both - time * of_slope) > all / 2;
    };
    return is_most(r.period / 2) && is_most(doubt_of_time(c));
}

/// Whether a drive with loops of its own lags by less than half a row otherwise than described: its clock and
/// its current loop, of which no file says more, are as late.
inline bool is_lag_within_a_row(const axis_case& c, const cause& named) {
    if (!c.axis.drive.closes() || named.effect != "actuator_lag") return false;
    const double described = c.models.given().fit.plant.lag;
    return std::abs(named.parameters.front().values.front().value - described) < c.record.period / 2;
}

/// Whether a cause acts on a command whose set-points between the rows are a guess: when they come is then one
/// as well.
inline bool rests_on_guessed_set_points(const axis_case& c, const effect& e) {
    return c.axis.drive.set_point_period_guessed && (e.box == "drive" || e.box == "actuator");
}

} // namespace quadrant::inline v0::diagnosis::detail
