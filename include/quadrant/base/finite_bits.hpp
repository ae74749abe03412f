// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "portable.hpp"

#include <cstdint>

/// What a number is, by its bits and not by std::isfinite or x != x: stays true to its word under -ffast-math,
/// by which a compiler may take it that there are no NaNs and no infinities.
namespace quadrant::inline v0::detail {

/// A number with its derivatives beside it (`dual`, or one of the user's own).
template <class T>
concept carries_partials = requires(const T& x) {
    x.value;
    x.partial;
};

constexpr bool is_finite(double x) noexcept {
    constexpr std::uint64_t exponent = 0x7ff0'0000'0000'0000;
    return (bits_as<std::uint64_t>(x) & exponent) != exponent;
}
constexpr bool is_finite(float x) noexcept {
    constexpr std::uint32_t exponent = 0x7f80'0000;
    return (bits_as<std::uint32_t>(x) & exponent) != exponent;
}
constexpr bool is_nan(double x) noexcept {
    return (bits_as<std::uint64_t>(x) & 0x7fff'ffff'ffff'ffff) > 0x7ff0'0000'0000'0000;
}

} // namespace quadrant::inline v0::detail
