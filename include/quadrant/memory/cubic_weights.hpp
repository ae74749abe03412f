// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>

namespace quadrant::inline v0::detail {

/// What each of four samples at 0, 1, 2, 3 counts for in the cubic through them (Lagrange), read at 1 + u, 0 <=
/// u <= 1.
template <class Number> constexpr std::array<Number, 4> cubic_weights(const Number& u) noexcept {
    const Number left = Number(1) + u, right = Number(1) - u, far = Number(2) - u;
    const Number half = Number(1) / Number(2), sixth = Number(1) / Number(6);
    return {-(u * right * far * sixth), left * right * far * half, left * u * far * half,
            -(left * u * right * sixth)};
}

} // namespace quadrant::inline v0::detail
