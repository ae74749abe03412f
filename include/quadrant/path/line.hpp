// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "point.hpp"

#include <algorithm>

namespace quadrant::inline v0::path {

/// Straight piece of a tool path, by its path length s [m] from its start; s beyond an end is held there.
/// Throws when the ends are not finite or the same place. Never allocates.
class line {
public:
    /// From and to: places [m].
    line(point from, point to) : from_(from), to_(to), length_(distance(from, to)) {
        require_positive("line.length", length_);
        tangent_ = (to - from) / length_;
    }
    double length() const noexcept { return length_; } ///< [m], above 0
    point start() const noexcept { return from_; }     ///< [m]
    point end() const noexcept { return to_; }         ///< [m]
    point position(double s) const noexcept {          ///< [m]; exact at both ends
        return s >= length_ ? to_ : from_ + std::max(s, 0.0) * tangent_;
    }
    point tangent(double) const noexcept { return tangent_; } ///< unit vector
    point curvature(double) const noexcept { return {}; }     ///< 1/m: none

private:
    point from_, to_, tangent_;
    double length_;
};

} // namespace quadrant::inline v0::path
