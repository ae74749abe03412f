// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "point.hpp"

#include <algorithm>
#include <cmath>

namespace quadrant::inline v0::path {

/// Circular piece of a tool path in the xy plane, or a helix about z, by its path length s [m] from its start;
/// s beyond an end is held there.
///   r(s) = c + R [cos a, sin a] + [0, 0, z0 + rise s/L],  a = a0 + sweep s/L,  L = hypot(R sweep, rise)
/// The tangent is the derivative of r; the curvature vector points to the axis, R (sweep/L)^2 long (1/R without
/// rise). Throws for what is not finite, for no radius and for no sweep. Never allocates.
class arc {
public:
    /// `start` [m]; `centre` [m], its z does not count; `sweep` [rad], positive counterclockwise seen against
    /// z, more than a turn allowed; `rise` along z over the whole piece [m].
    arc(point start, point centre, double sweep, double rise = 0)
        : start_(start), centre_{centre.x, centre.y, 0}, sweep_(sweep), rise_(rise),
          radius_(std::hypot(start.x - centre.x, start.y - centre.y)),
          angle_(std::atan2(start.y - centre.y, start.x - centre.x)),
          length_(std::hypot(radius_ * sweep, rise)) {
        require_positive("arc.radius", radius_);
        require(detail::is_finite(sweep) && sweep != 0, "arc.sweep", sweep, "must be finite and not 0");
        require_finite("arc.z", start.z);
        require_finite("arc.rise", rise);
        require_positive("arc.length", length_);
        turning_ = sweep_ / length_;
        climb_ = rise_ / length_;
    }
    double length() const noexcept { return length_; }       ///< [m], above 0
    point start() const noexcept { return start_; }          ///< [m]
    point end() const noexcept { return position(length_); } ///< [m]
    point position(double s) const noexcept {                ///< [m]; exact at the start
        if (s <= 0) return start_;
        const double a = angle(s), held = std::min(s, length_);
        return {centre_.x + radius_ * std::cos(a), centre_.y + radius_ * std::sin(a), start_.z + climb_ * held};
    }
    point tangent(double s) const noexcept { ///< unit vector
        const double a = angle(s), around = radius_ * turning_;
        return {-around * std::sin(a), around * std::cos(a), climb_};
    }
    point curvature(double s) const noexcept { ///< vector to the axis [1/m]
        const double a = angle(s), k = radius_ * turning_ * turning_;
        return {-k * std::cos(a), -k * std::sin(a), 0};
    }
    double radius() const noexcept { return radius_; } ///< [m]
    double sweep() const noexcept { return sweep_; }   ///< [rad], negative clockwise
    point centre() const noexcept { return centre_; }  ///< [m], z = 0

private:
    double angle(double s) const noexcept { return angle_ + turning_ * std::clamp(s, 0.0, length_); }

    point start_, centre_;
    double sweep_, rise_, radius_, angle_, length_, turning_ = 0, climb_ = 0;
};

} // namespace quadrant::inline v0::path
