// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../block/axis_motion.hpp"
#include "../trajectory/interpolator.hpp"
#include "contour_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Largest and root mean square of a signal.
struct contour_extent {
    displacement most{}, rms{};
};
/// How two axes followed a contour.
struct contour_figures {
    contour_extent x, y;      ///< tracking errors, reference minus table
    contour_extent contour;   ///< distance of the table from the path
    contour_extent estimated; ///< `estimated_contour_error` of every period that moves
    std::vector<displacement> x_error, y_error,
        contour_error;             ///< sample by sample; contour: left of the path positive
    quantity<si::time> duration{}; ///< of the motion
};

/// How a contour is driven and judged.
struct contour_options {
    trajectory::machine_limits limits;
    trajectory::profile_kind kind = trajectory::profile_kind::trapezoidal_acceleration;
    std::size_t lead =
        0; ///< periods that the reference is asked before it is due (lead() of the law's preview)
    displacement spacing =
        displacement::from_value(1e-5); ///< of the places at which it is evaluated: s^2/(8 R) exact
    displacement window = displacement::from_value(2e-3); ///< along the path: `sampled_path`
};

namespace detail {
/// Places along a path, at most `spacing` apart.
inline std::vector<plane_position> places_along(const std::vector<path::move>& moves, displacement spacing) {
    const auto at = [](path::point p) {
        return plane_position{displacement::from_value(p.x), displacement::from_value(p.y)};
    };
    std::vector<plane_position> places{at(moves.front().path.start())};
    for (const path::move& m : moves) {
        const double length = m.path.length();
        const auto pieces = static_cast<std::size_t>(std::ceil(length / spacing.value()));
        for (std::size_t i = 1; i <= pieces; ++i)
            places.push_back(at(m.path.position(length * double(i) / double(pieces))));
    }
    return places;
}
/// The largest error and its rms.
inline contour_extent extent_of(const std::vector<displacement>& of) {
    double most = 0, squares = 0;
    for (const displacement& e : of) {
        most = std::max(most, std::abs(e.value()));
        squares += e.value() * e.value() / double(of.size());
    }
    return contour_extent{displacement::from_value(most), displacement::from_value(std::sqrt(squares))};
}
} // namespace detail

/// Drives a contour and measures: the trajectory of the moves, sample by sample, to `axes`, which gives back
/// where the table was before that sample's command acts. Until a tenth of a second after the end.
///   plane_position axes(const axis_motion<>& x, const axis_motion<>& y)
/// The path is judged as the moves are, not as the trajectory was: rounded corners count as contour error.
/// Allocates. Throws what `interpolator` and `sampled_path` throw.
template <class Axes>
contour_figures drive_contour(const std::vector<path::move>& moves, Axes&& axes, const contour_options& how,
                              duration period) {
    require(!moves.empty(), "drive_contour.moves", 0.0, "must be one or more");
    require_positive("drive_contour.spacing", how.spacing);
    sampled_path path(detail::places_along(moves, how.spacing), how.window);

    const auto drive = std::make_unique<trajectory::interpolator<>>(
        trajectory::interpolator<>::parameters{how.limits, how.kind}, period);
    std::size_t next = 0;
    contour_figures y;
    struct asked {
        axis_motion<> x, y;
    };
    std::deque<asked> coming; // asked for and not due yet
    std::vector<displacement> estimated;
    const auto feed = [&] {
        while (next < moves.size() && !drive->full()) drive->push(moves[next++]);
    };
    const auto motion_of = [](const trajectory::motion& m) {
        return axis_motion<>{m.position, m.velocity, m.acceleration};
    };
    feed();
    const asked first{{drive->now().axis[0].position, {}, {}}, {drive->now().axis[1].position, {}, {}}};
    coming.assign(how.lead, first);
    const auto after = static_cast<long>(std::ceil(0.1 / period.value())) + static_cast<long>(how.lead);
    asked now = first;
    for (long rest = after; rest >= 0;) {
        coming.push_back(now);
        const asked due = coming.front();
        coming.pop_front();
        const plane_position table = axes(now.x, now.y);
        y.x_error.push_back(due.x.position - table.x), y.y_error.push_back(due.y.position - table.y);
        y.contour_error.push_back(path(table).error);
        if (const auto e = estimated_contour_error({due.x.position, due.y.position}, table, due.x.velocity,
                                                   due.y.velocity))
            estimated.push_back(*e);
        feed();
        if (next < moves.size() || !drive->done()) {
            const auto& r = (*drive)();
            now = {motion_of(r.axis[0]), motion_of(r.axis[1])};
            y.duration += period;
        } else {
            now = {{now.x.position, {}, {}}, {now.y.position, {}, {}}};
            --rest;
        }
    }
    y.x = detail::extent_of(y.x_error), y.y = detail::extent_of(y.y_error);
    y.contour = detail::extent_of(y.contour_error), y.estimated = detail::extent_of(estimated);
    return y;
}

} // namespace quadrant::inline v0::analysis
