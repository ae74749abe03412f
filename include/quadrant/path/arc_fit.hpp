// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "arc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace quadrant::inline v0::path {

/// What programs write of an arc is rounded: its end may lie this far off the circle about its centre through
/// its start [m].
inline constexpr double arc_end_tolerance = 1e-5;

/// The arc in the xy plane from `start` to `end` about `centre` [m], a helix if their z differ; a full turn
/// when they are the same place in xy. The centre moves along the chord to where both ends are equally far, so
/// that the next move begins where this one ends. None when the end is not on the arc: further off than
/// arc_end_tolerance, a tenth of the radius or a quarter of the chord.
inline std::optional<arc> arc_about(point start, point end, point centre, bool clockwise) {
    const double way = clockwise ? -1 : 1, turn = 2 * std::numbers::pi;
    const double cx = centre.x, cy = centre.y;
    const double r0 = std::hypot(start.x - cx, start.y - cy), r1 = std::hypot(end.x - cx, end.y - cy);
    const double dx = end.x - start.x, dy = end.y - start.y, chord = std::hypot(dx, dy);
    if (!(r0 > same_place)) return {};
    if (chord <= same_place) return arc(start, centre, way * turn, end.z - start.z);
    if (!(std::abs(r1 - r0) <= std::min({arc_end_tolerance, 0.1 * r0, 0.25 * chord}))) return {};
    const double mx = 0.5 * (start.x + end.x), my = 0.5 * (start.y + end.y);
    const double height = ((cy - my) * dx - (cx - mx) * dy) / chord; // of the centre to the left of the chord
    const point moved{mx - height * dy / chord, my + height * dx / chord, 0};
    const double sweep = 2 * std::atan2(0.5 * chord, way * height); // 0 ... a turn
    return arc(start, moved, way * sweep, end.z - start.z);
}

/// Centre of the arc from `start` to `end` with this radius [m]; a negative one means the longer way round.
/// None when they are further apart than twice the radius (by more than arc_end_tolerance), or the same place.
inline std::optional<point> arc_centre(point start, point end, double radius, bool clockwise) {
    const double dx = end.x - start.x, dy = end.y - start.y, chord = std::hypot(dx, dy);
    const double r = std::abs(radius), half = 0.5 * chord;
    if (!(chord > same_place) || !(half - r <= std::min(arc_end_tolerance, 0.1 * r))) return {};
    const double height = r > half ? std::sqrt((r - half) * (r + half)) : 0;
    const double side = (clockwise == (radius > 0) ? -1 : 1) * height / chord; // left of the chord is positive
    return point{0.5 * (start.x + end.x) - side * dy, 0.5 * (start.y + end.y) + side * dx, 0};
}

} // namespace quadrant::inline v0::path
