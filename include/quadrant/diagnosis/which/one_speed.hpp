// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"

#include <algorithm>
#include <cmath>

namespace quadrant::inline v0::diagnosis::detail {

/// Speeds of a motion that differ by less than this share of them, in rms, show no law of the speed: two laws
/// differ by less than that share of the force, and what else acts does more.
inline constexpr double one_speed = 0.2;

/// Whether a record moves at one speed, in either direction.
inline bool of_one_speed(const axis_record& r) {
    double most = 0, rows = 0, sum = 0, square_sum = 0;
    for (const double v : r.velocity) most = std::max(most, std::abs(v));
    for (const double v : r.velocity)
        if (std::abs(v) > 0.1 * most) ++rows, sum += std::abs(v), square_sum += v * v;
    return rows > 0 && 1 - sum * sum / (rows * square_sum) < one_speed * one_speed;
}

} // namespace quadrant::inline v0::diagnosis::detail
