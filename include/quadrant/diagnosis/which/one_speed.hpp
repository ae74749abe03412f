// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"

#include <algorithm>
#include <cmath>

namespace quadrant::inline v0::diagnosis::detail {

/// By how much the speeds of a motion differ from one, as a share of them; 0: by more than a fifth, and a law
/// of the speed shows which it is.
inline double speeds_of(const axis_record& r) {
    double most = 0, rows = 0, sum = 0, square_sum = 0;
    for (const double v : r.velocity) most = std::max(most, std::abs(v));
    for (const double v : r.velocity)
        if (std::abs(v) > 0.1 * most) ++rows, sum += std::abs(v), square_sum += v * v;
    if (!(rows > 0)) return 0;
    const double spread = std::sqrt(std::max(0.0, 1 - sum * sum / (rows * square_sum)));
    return spread < 0.2 ? spread : 0;
}

} // namespace quadrant::inline v0::diagnosis::detail
