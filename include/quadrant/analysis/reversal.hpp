// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant_glitch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace quadrant::inline v0::analysis {

/// The spike that a reversal leaves in the tracking error of one axis; as `reversal_spike` of the circular test
/// does for the circle.
struct axis_spike {
    glitch found;                         ///< time and direction of the reversal, peak error
    quantity_of<signal::position> height; ///< found.jump: above the error at the reversal; signed
    duration width;  ///< between the two half heights; to the end of the window where it does not fall
    duration offset; ///< of the top from the reversal
};

/// Height, width and time of every reversal's spike: of `quadrant_glitches`, for the same reversals and
/// windows.
inline std::vector<axis_spike> reversal_spikes(const std::vector<quantity_of<signal::position>>& reference,
                                               const std::vector<quantity_of<signal::position>>& position,
                                               duration period, const glitch_options& options) {
    std::vector<axis_spike> out;
    const auto width = std::size_t(std::floor(options.window / period + 1e-9));
    const auto all = quadrant_glitches(reference, position, period, options);
    const auto sample = [&](const glitch& g) { return std::size_t(std::lround(double(g.at / period))); };
    for (std::size_t n = 0; n < all.size(); ++n) {
        const glitch& g = all[n];
        const std::size_t start = sample(g);
        const auto above = [&](std::size_t i) { // of the height, 1 at the top
            const auto e = (reference[i] - position[i]) - (reference[start] - position[start]);
            return g.jump.value() == 0 ? 0 : e.value() / g.jump.value();
        };
        const std::size_t end =
            n + 1 < all.size() ? std::min(start + width, sample(all[n + 1])) : start + width;
        std::size_t top = start;
        while (top < end && above(top) < 1) ++top;
        std::size_t rise = top, fall = top;
        while (rise > start && above(rise) >= 0.5) --rise;
        while (fall < end && above(fall) >= 0.5) ++fall;
        const auto crossing = [&](std::size_t low, std::size_t high) { // in samples
            const double a = above(low), b = above(high);
            return a < 0.5 && b >= 0.5 ? double(low) + (double(high) - double(low)) * (0.5 - a) / (b - a)
                                       : double(low);
        };
        const bool flat = g.jump.value() == 0;
        out.push_back({g, g.jump,
                       flat ? duration() : (crossing(fall, fall - 1) - crossing(rise, rise + 1)) * period,
                       flat ? duration() : double(top - start) * period});
    }
    return out;
}

} // namespace quadrant::inline v0::analysis
