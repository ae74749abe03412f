// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// The probability that the cause is none of the suspects, when `left` stays beside what it explains (in
/// force). At the noise nothing is left that could speak for it. While structure is left, the whole may be of a
/// shape that no name has, and the name its nearest. One law takes at least this share of a shape drawn at
/// random among `shapes` independent ones with the probability (1 - share)^((shapes - 1)/2); as many laws were
/// tried as there are `suspects`.
inline double by_chance(std::size_t suspects, double left) {
    constexpr double shapes =
        13; // a jump, a slope and a bend in velocity, position, time and command, and a mean
    const double share = 1 / (1 + left * left), names = static_cast<double>(suspects);
    return std::min(0.03 + names * std::pow(1 - share, (shapes - 1) / 2), 0.95);
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
