// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../path/move.hpp"
#include "../path/spline_path.hpp"
#include "response.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

/// The contours that feed drives are usually tried on, in the xy plane around its origin, as moves for an
/// `interpolator`.
namespace quadrant::inline v0::analysis {

/// Speed along a contour [m/s].
using contour_feed = quantity<si::velocity>;

/// One turn from `start` (an angle in degrees, counterclockwise from x), from rest to rest.
inline std::vector<path::move> circle_contour(quantity<si::length> radius, contour_feed feed, double start = 90,
                                              bool counterclockwise = true) {
    require_positive("circle_contour.radius", radius);
    require_positive("circle_contour.feed", feed);
    const double a = start * std::numbers::pi / 180, r = radius.value();
    const double turn = counterclockwise ? 2 * std::numbers::pi : -2 * std::numbers::pi;
    return {
        {.path = path::arc({r * std::cos(a), r * std::sin(a), 0}, {}, turn), .feed = feed.value(), .line = 1}};
}

/// Counterclockwise along the corners; tolerance 0: a stop in each, else on within it. The last move stops.
inline std::vector<path::move> polygon_contour(const std::vector<path::point>& corners, contour_feed feed,
                                               quantity<si::length> tolerance = {}) {
    require(corners.size() >= 3, "polygon_contour.corners", double(corners.size()), "must be three or more");
    require_positive("polygon_contour.feed", feed);
    require_not_negative("polygon_contour.tolerance", tolerance);
    std::vector<path::move> moves;
    for (std::size_t i = 0; i < corners.size(); ++i)
        moves.push_back({.path = path::line(corners[i], corners[(i + 1) % corners.size()]),
                         .feed = feed.value(),
                         .ending = tolerance.value() > 0 && i + 1 < corners.size()
                                       ? path::path_ending::continuous
                                       : path::path_ending::exact_stop,
                         .tolerance = i + 1 < corners.size() ? tolerance.value() : 0,
                         .line = i + 1});
    return moves;
}
/// A square on its corner, from the lowest: both axes move on every side.
inline std::vector<path::move> diamond_contour(quantity<si::length> side, contour_feed feed,
                                               quantity<si::length> tolerance = {}) {
    require_positive("diamond_contour.side", side);
    const double r = side.value() * std::numbers::sqrt2 / 2;
    return polygon_contour({{0, -r, 0}, {r, 0, 0}, {0, r, 0}, {-r, 0, 0}}, feed, tolerance);
}
/// A square along the axes, from its lower left corner: on every side one axis stands still.
inline std::vector<path::move> square_contour(quantity<si::length> side, contour_feed feed,
                                              quantity<si::length> tolerance = {}) {
    require_positive("square_contour.side", side);
    const double h = side.value() / 2;
    return polygon_contour({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, feed, tolerance);
}
/// r = size (e^{cos t} - 2 cos 4t), clockwise from its top, as quintic splines through `places` places:
/// curvature of both signs, bends down to size/55, many reversals of both axes. About 9 size wide.
inline std::vector<path::move> butterfly_contour(quantity<si::length> size, contour_feed feed,
                                                 std::size_t places = 360) {
    require_positive("butterfly_contour.size", size);
    require_positive("butterfly_contour.feed", feed);
    require(places >= 60, "butterfly_contour.places", double(places), "must be 60 or more");
    path::spline_path path(path::spline_degree::quintic);
    for (std::size_t i = 0; i <= places; ++i) {
        const double t = 2 * std::numbers::pi * double(i) / double(places),
                     r = size.value() * (std::exp(std::cos(t)) - 2 * std::cos(4 * t));
        path.add({r * std::sin(t), r * std::cos(t), 0});
    }
    path.finish();
    std::vector<path::move> moves;
    while (const auto piece = path.next())
        moves.push_back({.path = piece->curve,
                         .feed = feed.value(),
                         .ending = path::path_ending::continuous,
                         .line = piece->knot});
    moves.back().ending = path::path_ending::exact_stop;
    return moves;
}

} // namespace quadrant::inline v0::analysis
