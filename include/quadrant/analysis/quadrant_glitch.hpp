// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace quadrant::inline v0::analysis {

/// The tracking error that follows one reversal of an axis.
struct glitch {
    duration at;   ///< of the reversal: the last sample of the old direction, from the first sample on
    int direction; ///< +1: moves to plus from here on, -1: to minus
    quantity_of<signal::position> peak; ///< reference minus position, the one of largest size; signed
    quantity_of<signal::position> jump; ///< the same, from the error at the reversal on
    duration delay;                     ///< of the peak from the reversal
};

/// How far behind a reversal its peak is looked for, and from when on.
struct glitch_options {
    duration
        window; ///< after a reversal in which its peak is looked for; > 0, ends at the next reversal anyway
    duration settle{}; ///< reversals before this are left out: the run in
};

/// Quadrant glitches: peak tracking error after every reversal of the reference, [Jamaludin2008] tables 4.2 and
/// 4.4. A reversal is where the reference moves the other way than it last moved; a rest between the two
/// belongs to the old. The last one counts only when its whole window was recorded. None: the list is empty.
inline std::vector<glitch> quadrant_glitches(const std::vector<quantity_of<signal::position>>& reference,
                                             const std::vector<quantity_of<signal::position>>& position,
                                             duration period, const glitch_options& options) {
    require_positive("quadrant_glitches.period", period);
    require(reference.size() == position.size(), "quadrant_glitches.reference", double(reference.size()),
            "must hold as many samples as position (" + quadrant::detail::shortest(double(position.size())) +
                ")");
    require(options.window >= period, "quadrant_glitches.window", options.window,
            "must not be below the period (" + quadrant::detail::shortest(period) + ")");
    require_not_negative("quadrant_glitches.settle", options.settle);
    std::vector<std::size_t> turns;
    std::vector<int> directions;
    int moving = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        require(std::isfinite(reference[i].value()) && std::isfinite(position[i].value()),
                "quadrant_glitches.sample", double(i), "must be finite");
        if (i == 0 || reference[i] == reference[i - 1]) continue;
        const int now = reference[i] > reference[i - 1] ? 1 : -1;
        if (moving != 0 && now != moving) turns.push_back(i - 1), directions.push_back(now);
        moving = now;
    }
    const auto width = std::size_t(std::floor(options.window / period + 1e-9));
    std::vector<glitch> out;
    for (std::size_t t = 0; t < turns.size(); ++t) {
        const std::size_t start = turns[t],
                          end = t + 1 < turns.size() ? std::min(start + width, turns[t + 1]) : start + width;
        if (end >= reference.size() || double(start) * period < options.settle) continue;
        glitch g{double(start) * period, directions[t], {}, {}, {}};
        const auto before = reference[start] - position[start];
        for (std::size_t k = start; k <= end; ++k) {
            const auto e = reference[k] - position[k];
            if (std::abs(e.value()) > std::abs(g.peak.value()))
                g.peak = e, g.delay = double(k - start) * period;
            if (std::abs((e - before).value()) > std::abs(g.jump.value())) g.jump = e - before;
        }
        out.push_back(g);
    }
    return out;
}

/// The largest of them, as the thesis' tables give it; 0 when there is none.
inline quantity_of<signal::position> largest_glitch(const std::vector<glitch>& all) {
    quantity_of<signal::position> out{};
    for (const glitch& each : all) out = std::max(out, each.peak < -each.peak ? -each.peak : each.peak);
    return out;
}

} // namespace quadrant::inline v0::analysis
