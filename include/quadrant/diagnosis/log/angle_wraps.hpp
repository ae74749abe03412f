// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// How often an angle starts again, as a counter of one turn does, and makes it go on instead [rad]. Such an
/// angle never leaves one turn; it jumps from one end of that turn to the other; and no other step is longer
/// than an eighth of a turn, so that none is taken for a jump. Anything else is left as it is, 0. How far it
/// went where rows are missing nobody knows: it goes on by less than half a turn there. `after_gap`: of each
/// row, whether rows are missing before it; empty: none is.
inline std::size_t unwrap(std::vector<double>& angle, std::span<const unsigned char> after_gap = {}) {
    constexpr double turn = 2 * std::numbers::pi;
    if (angle.size() < 2) return 0;
    const auto [low_at, high_at] = std::minmax_element(angle.begin(), angle.end());
    const double low = *low_at, high = *high_at;
    double longest = 0;
    std::size_t jumps = 0;
    const auto known = [&](std::size_t k) { return after_gap.empty() || !after_gap[k]; };
    const auto is_jump = [&](std::size_t k) {
        return known(k) && std::abs(angle[k] - angle[k - 1]) > turn / 2;
    };
    for (std::size_t k = 1; k < angle.size(); ++k) {
        if (!known(k)) continue;
        const double step = angle[k] - angle[k - 1];
        longest = std::max(longest, std::abs(step - (is_jump(k) ? std::copysign(turn, step) : 0)));
        jumps += is_jump(k);
    }
    if (jumps == 0 || longest > turn / 8 || high - low > turn * (1 + 1e-6)) return 0;
    for (std::size_t k = 1; k < angle.size(); ++k) {
        if (!is_jump(k)) continue;
        const double from_end = std::max(std::min(angle[k - 1] - low, high - angle[k - 1]),
                                         std::min(angle[k] - low, high - angle[k]));
        if (from_end > longest) return 0;
    }
    double whole = 0, before = angle[0];
    for (std::size_t k = 1; k < angle.size(); ++k) {
        const double step = angle[k] - before;
        before = angle[k];
        if (std::abs(step) > turn / 2) whole -= std::copysign(turn, step);
        angle[k] += whole;
    }
    return jumps;
}

/// Moves an angle by the whole turns that bring it nearest to another one.
inline void turn_to(std::vector<double>& angle, const std::vector<double>& other) {
    constexpr double turn = 2 * std::numbers::pi;
    double apart = 0;
    for (std::size_t k = 0; k < angle.size(); ++k)
        apart += (other[k] - angle[k]) / static_cast<double>(angle.size());
    for (double& a : angle) a += turn * std::round(apart / turn);
}

} // namespace quadrant::inline v0::diagnosis::detail
