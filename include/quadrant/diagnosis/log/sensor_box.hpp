// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// The step in which a position column really moves: the smallest difference that nearly all differences of
/// neighbouring rows are multiples of; at least the rounding of the column. Needs no dynamics. 0: it never
/// moves.
inline double observed_count(std::span<const double> position, double rounding) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < position.size(); ++k)
        if (const double d = std::abs(position[k] - position[k - 1]); d > rounding) steps.push_back(d);
    if (steps.empty()) return 0;
    // The smallest difference that occurs more than by accident, one in a thousand rows; of an axis that is
    // fast in nearly all rows, the smallest of all.
    const std::size_t few = steps.size() / 1000;
    for (const std::size_t rank : {few, std::size_t{0}}) {
        const auto at = steps.begin() + static_cast<std::ptrdiff_t>(rank);
        std::nth_element(steps.begin(), at, steps.end());
        const double count = *at;
        std::size_t multiples = 0;
        for (double d : steps)
            if (std::abs(d - std::round(d / count) * count) <= rounding + 0.1 * count) ++multiples;
        // Of any differences a fifth, and more where the count is a few roundings, are near a multiple.
        const bool by_itself = rank == few || rounding < 0.15 * count;
        if (by_itself && 10 * multiples >= 9 * steps.size()) return count;
    }
    return rounding;
}

} // namespace quadrant::inline v0::diagnosis
