// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"

#include <cmath>

namespace quadrant::inline v0::path {

/// A place, a direction or a curvature in the coordinates of the machine: plain numbers in SI, because the
/// mathematics of a path mixes its axes. Places are metres, unit tangents have no unit, curvatures are 1/m: the
/// name of each says it.
struct point {
    double x = 0, y = 0, z = 0;

    static constexpr int axes = 3;
    /// Axis 0, 1, 2 is x, y, z.
    constexpr double operator[](int axis) const noexcept { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr double& operator[](int axis) noexcept { return axis == 0 ? x : axis == 1 ? y : z; }

    friend constexpr point operator+(point a, point b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr point operator-(point a, point b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr point operator-(point a) noexcept { return {-a.x, -a.y, -a.z}; }
    friend constexpr point operator*(double k, point a) noexcept { return {k * a.x, k * a.y, k * a.z}; }
    friend constexpr point operator/(point a, double k) noexcept { return {a.x / k, a.y / k, a.z / k}; }
    constexpr point& operator+=(point b) noexcept { return *this = *this + b; }
    friend constexpr bool operator==(point a, point b) noexcept = default;
};

/// Places nearer than this are the same [m]: there is no way to go between them.
inline constexpr double same_place = 1e-9;

constexpr double dot(point a, point b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// Of lengths between 1e-150 and 1e150 m: `std::hypot`, which knows more, takes ten times as long.
inline double magnitude(point a) noexcept { return std::sqrt(dot(a, a)); }
inline double distance(point a, point b) noexcept { return magnitude(b - a); }
constexpr bool finite(point a) noexcept { return quadrant::finite(a.x, a.y, a.z); }

} // namespace quadrant::inline v0::path
