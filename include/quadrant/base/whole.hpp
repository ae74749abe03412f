// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cmath>
#include <concepts>
#include <cstdint>

namespace quadrant::inline v0::detail {

/// std::round, bit for bit: the nearest whole number, halves away from zero. On x86 that is a call of the C
/// library, which takes 40 instructions; here it is a conversion to an integer and back. Other number types
/// bring their own `round`.
template <class Real> Real whole(const Real& x) noexcept {
    using std::round;
#if defined(__x86_64__) || defined(__i386__)
    if constexpr (std::same_as<Real, double>) {
        const double size = std::abs(x);
        if (!(size < 0x1p52)) return x; // whole, or not finite
        const double below = double(std::int64_t(size));
        const double rest = size - below; // exact, and so is its double: no branch that noise would mislead
        return std::copysign(below + double(std::int64_t(rest + rest)), x);
    } else
#endif
        return round(x);
}

} // namespace quadrant::inline v0::detail
