// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../path/segment.hpp"
#include "limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

namespace quadrant::inline v0::trajectory {

/// d^3r/ds^3 of a piece of path [1/m^2]. Of a spline: the slope of its curvature vector, by a central
/// difference over a thousandth of the piece.
inline path::point third_derivative(const path::segment& path, double s) noexcept {
    if (std::get_if<path::line>(&path.shape())) return {};
    if (const auto* round = std::get_if<path::arc>(&path.shape())) {
        const double turning = round->sweep() / round->length();
        path::point t = round->tangent(s);
        t.z = 0;
        return -turning * turning * t;
    }
    const double h = 0.5e-3 * path.length(), from = std::max(s - h, 0.0), to = std::min(s + h, path.length());
    return (path.curvature(to) - path.curvature(from)) / (to - from);
}

/// The largest that the derivatives of a piece of path by its length become: each axis alone, and as vectors.
/// Line: as it is. Arc: the value in its middle plus what it can gain to an end, at most that of the circle.
/// Spline: from differences of its places on a grid of 48 (so with its feed correction), with 2, 5 and 25 % for
/// what lies between, and the same of its tangent, curvature and third derivative there.
struct path_shape {
    path::point slope; ///< |dr/ds|
    path::point bend;  ///< |d^2r/ds^2| [1/m]
    path::point twist; ///< |d^3r/ds^3| [1/m^2]
    double curved;     ///< magnitude of d^2r/ds^2 [1/m]

    explicit path_shape(const path::segment& path) noexcept : curved(0) {
        const auto each = [](path::point& most, double share, path::point with) {
            for (int i = 0; i < 3; ++i) most[i] = std::max(most[i], share * std::abs(with[i]));
        };
        if (const auto* round = std::get_if<path::arc>(&path.shape())) {
            const double middle = 0.5 * path.length(), turning = std::abs(round->sweep() / path.length());
            const double around = round->radius() * turning;
            each(slope, 1, path.tangent(middle));
            each(bend, 1, path.curvature(middle));
            curved = around * turning;
            for (int i = 0; i < 2; ++i) {
                slope[i] = std::min(around, slope[i] + curved * middle);
                bend[i] = std::min(curved, bend[i] + curved * turning * middle);
                twist[i] = turning * turning * slope[i];
            }
        } else if (std::get_if<path::line>(&path.shape())) {
            each(slope, 1, path.tangent(0));
        } else {
            constexpr int cells = 48;
            const double h = path.length() / cells;
            std::array<path::point, 4> last{}; // the places, newest first
            for (int i = 0; i <= cells; ++i) {
                last = {path.position(h * i), last[0], last[1], last[2]};
                each(slope, 1.02, path.tangent(h * i));
                each(bend, 1.05, path.curvature(h * i));
                each(twist, 1.25, third_derivative(path, h * i));
                if (i >= 1) each(slope, 1.02, (last[0] - last[1]) / h);
                if (i >= 2) {
                    const path::point k = (last[0] - 2 * last[1] + last[2]) / (h * h);
                    each(bend, 1.05, k);
                    curved = std::max(curved, 1.05 * magnitude(k));
                }
                if (i >= 3) each(twist, 1.25, (last[0] - 3 * last[1] + 3 * last[2] - last[3]) / (h * h * h));
            }
        }
    }
};

/// Limits of each axis (x, y, z) and along the path.
struct machine_limits {
    std::array<motion_limits, 3> axis;
    motion_limits path; ///< speed, its rate of change and the rate of that along the path
};

/// The same as plain numbers.
struct plain_limits {
    std::array<bounds, 3> axis;
    bounds path;
    explicit plain_limits(const machine_limits& of)
        : axis{plain(of.axis[0]), plain(of.axis[1]), plain(of.axis[2])}, path(plain(of.path)) {}
};

/// What the speed along a piece may do so that every axis stays within its limits: with r(s(t)),
///   x' = r' v,   x'' = r' a + r'' v^2,   x''' = r' j + 3 r'' v a + r''' v^3,
/// speed first (r'' v^2 may take 0.6 of an axis' acceleration and r''' v^3 0.3 of its jerk), then acceleration
/// (3 r'' v a may take 0.3 of the jerk), then jerk with the rest; every product at its largest over the piece.
/// Where the vector of both parts, hypot(a, curvature v^2), is within the limit of an axis, that is enough for
/// it.
/// Source: chain rule; [Altintas2012] for the mapping of axis limits to the path.
inline bounds along_path(const path_shape& shape, double feed, const plain_limits& within) noexcept {
    bounds b{std::min(feed, within.path.velocity), within.path.acceleration, within.path.jerk};
    for (int i = 0; i < 3; ++i) {
        const bounds& axis = within.axis[std::size_t(i)];
        if (shape.slope[i] > 0) b.velocity = std::min(b.velocity, axis.velocity / shape.slope[i]);
        if (shape.bend[i] > 0)
            b.velocity = std::min(b.velocity, std::sqrt(0.6 * axis.acceleration / shape.bend[i]));
        if (shape.twist[i] > 0) b.velocity = std::min(b.velocity, std::cbrt(0.3 * axis.jerk / shape.twist[i]));
    }
    const double v = b.velocity, across = shape.curved * v * v;
    for (int i = 0; i < 3; ++i) {
        const bounds& axis = within.axis[std::size_t(i)];
        if (!(shape.slope[i] > 0) || axis.acceleration == unlimited) continue;
        const double left = (axis.acceleration - shape.bend[i] * v * v) / shape.slope[i];
        const double as_vector =
            across < axis.acceleration ? std::sqrt(axis.acceleration * axis.acceleration - across * across) : 0;
        b.acceleration = std::min(b.acceleration, std::max(left, as_vector / std::max(1.0, shape.slope[i])));
    }
    for (int i = 0; i < 3; ++i)
        if (shape.bend[i] > 0)
            b.acceleration =
                std::min(b.acceleration, 0.3 * within.axis[std::size_t(i)].jerk / (3 * shape.bend[i] * v));
    for (int i = 0; i < 3; ++i) {
        const bounds& axis = within.axis[std::size_t(i)];
        if (!(shape.slope[i] > 0) || axis.jerk == unlimited) continue;
        const double taken = (3 * shape.bend[i] * b.acceleration + shape.twist[i] * v * v) * v;
        b.jerk = std::min(b.jerk, (axis.jerk - taken) / shape.slope[i]);
    }
    return b;
}

} // namespace quadrant::inline v0::trajectory
