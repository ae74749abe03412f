// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../select.hpp"

namespace quadrant::detail {

/// The play operator: where the driven side stands when the driving side is at x and the driven one was at `before`. The one
/// place of this law; `backlash` and `servo_axis` ask it.
template <class Value>
constexpr Value play_law(const Value& before, const Value& x, const Value& half) noexcept {
    const Value low = x - half, high = x + half;
    return select(less(before, low), low, select(greater(before, high), high, before));
}

} // namespace quadrant::detail
