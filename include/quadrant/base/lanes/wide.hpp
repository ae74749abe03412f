// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "number.hpp"

#include <array>
#include <cstddef>

/// Several numbers of lanes side by side in one wider number: the springs of a friction, the taps of a filter.
/// Where the wider one fills wider registers, no number goes through memory on its way.
namespace quadrant {

namespace detail {
#if defined(XSIMD_HPP) && XSIMD_WITH_AVX
/// A register of two numbers twice in a register of four, and its halves.
template <class Wide, class Narrow> Wide doubled(const Narrow& x) noexcept {
    const __m128d one = x;
    return Wide(_mm256_insertf128_pd(_mm256_castpd128_pd256(one), one, 1));
}
template <class Narrow, class Wide> Narrow half(const Wide& x, std::size_t upper) noexcept {
    const __m256d both = x;
    return Narrow(upper == 0 ? _mm256_castpd256_pd128(both) : _mm256_extractf128_pd(both, 1));
}
inline constexpr bool has_doubled = true;
#else
inline constexpr bool has_doubled = false;
template <class Wide, class Narrow> Wide doubled(const Narrow& x) noexcept { return x; }
template <class Narrow, class Wide> Narrow half(const Wide& x, std::size_t) noexcept { return x; }
#endif
} // namespace detail

/// The lanes of x, N times one behind the other.
template <std::size_t N, std::size_t W, class Isa> lanes<N * W, Isa> repeated(const lanes<W, Isa>& x) noexcept {
    using wide = lanes<N * W, Isa>;
    constexpr std::size_t narrow_width = lanes<W, Isa>::register_width, wide_width = wide::register_width;
    if constexpr (narrow_width == wide_width)
        return wide::from_registers([&](std::size_t i) { return x.in_register(i % (W / narrow_width)); });
    else if constexpr (detail::has_doubled && narrow_width == W && wide_width == 4 && narrow_width == 2) {
        const auto twice = detail::doubled<typename wide::piece>(x.in_register(0));
        return wide::from_registers([&](std::size_t) { return twice; });
    } else {
        std::array<double, N * W> all;
        for (std::size_t i = 0; i < N; ++i) x.write(all.data() + i * W);
        return wide::read(all.data());
    }
}
/// The i-th of the numbers of W lanes that x is made of.
template <std::size_t W, std::size_t Wide, class Isa>
requires(Wide % W == 0) lanes<W, Isa> part(const lanes<Wide, Isa>& x, std::size_t i)
noexcept {
    using narrow = lanes<W, Isa>;
    constexpr std::size_t narrow_width = narrow::register_width, wide_width = lanes<Wide, Isa>::register_width;
    if constexpr (narrow_width == wide_width)
        return narrow::from_registers([&](std::size_t k) { return x.in_register(i * (W / narrow_width) + k); });
    else if constexpr (detail::has_doubled && narrow_width == W && wide_width == 4 && narrow_width == 2)
        return narrow::from_registers(
            [&](std::size_t) { return detail::half<typename narrow::piece>(x.in_register(i / 2), i % 2); });
    else {
        std::array<double, Wide> all;
        x.write(all.data());
        return narrow::read(all.data() + i * W);
    }
}

} // namespace quadrant
