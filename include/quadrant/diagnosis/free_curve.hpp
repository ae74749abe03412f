// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

namespace quadrant::diagnosis {

/// A force of no particular form over one quantity: Legendre polynomials between two ends, constant outside. They reach over
/// the whole range, so that each stretch of motion says something about all of it.
struct free_curve {
    enum class over { nothing, position, velocity, time, command };
    static constexpr std::size_t terms = 6;
    over of = over::nothing;
    double low = 0, high = 1;         ///< ends, in the quantity's unit
    std::array<double, terms> size{}; ///< of each polynomial [N]

    double at(double z) const {
        const double x = std::clamp((2 * z - low - high) / (high - low), -1.0, 1.0);
        double before = 1, now = x, sum = size[0] + size[1] * x;
        for (std::size_t i = 2; i < terms; ++i) { // Bonnet's recursion
            const auto n = static_cast<double>(i);
            const double next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
            before = now;
            now = next;
            sum += size[i] * now;
        }
        return sum;
    }
};

} // namespace quadrant::diagnosis
