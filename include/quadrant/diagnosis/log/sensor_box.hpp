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
    std::sort(steps.begin(), steps.end());
    const auto multiples = [&](double count) { // in rows, and in differences of different size
        // Any size is near a multiple of a few roundings: there exact multiples alone count.
        const double near = 0.1 * count + (rounding < 0.15 * count ? rounding : 0);
        std::size_t rows = 0, sizes = 0, all = 0;
        double before = 0;
        for (const double d : steps) {
            const bool one = std::abs(d - std::round(d / count) * count) <= near;
            if (one) ++rows;
            if (d - before <= rounding) continue;
            before = d;
            ++all;
            if (one) ++sizes;
        }
        // Of any sizes a fifth are near a multiple. An axis that runs at one speed has one size in most rows.
        return 10 * rows >= 9 * steps.size() && 2 * sizes >= all;
    };
    // The smallest difference that occurs more than by accident, one in a thousand rows; of an axis that is
    // fast in nearly all rows, the smallest of all.
    const double often = steps[steps.size() / 1000], smallest = steps.front();
    return multiples(often) ? often : multiples(smallest) ? smallest : rounding;
}

} // namespace quadrant::inline v0::diagnosis
