// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "number.hpp"

#include <array>
#include <cstddef>
#include <utility>

/// Several numbers of lanes side by side in one wider number: the springs of a friction, the taps of a filter.
/// Where the wider one fills wider registers, no number goes through memory on its way.
namespace quadrant::inline v0 {

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
/// Two registers of two numbers in a register of four.
template <class Wide, class Narrow> Wide joined_registers(const Narrow& low, const Narrow& high) noexcept {
    const __m128d first = low, second = high;
    return Wide(_mm256_insertf128_pd(_mm256_castpd128_pd256(first), second, 1));
}
inline constexpr bool has_doubled = true;
#else
inline constexpr bool has_doubled = false;
template <class Wide, class Narrow> Wide doubled(const Narrow& x) noexcept { return x; }
template <class Narrow, class Wide> Narrow half(const Wide& x, std::size_t) noexcept { return x; }
template <class Wide, class Narrow> Wide joined_registers(const Narrow& low, const Narrow&) noexcept {
    return low;
}
#endif
#ifdef XSIMD_HPP
/// A register of two numbers to two places, and from two places.
template <class Narrow> void to_places(const Narrow& x, double* first, double* second) noexcept {
    const __m128d both = x;
    _mm_storel_pd(first, both);
    _mm_storeh_pd(second, both);
}
template <class Narrow> Narrow from_places(const double* first, const double* second) noexcept {
    return Narrow(_mm_set_pd(*second, *first));
}
/// The sum of each of two numbers of four lanes.
template <class Narrow, class Quad> Narrow sums_of_two(const Quad& a, const Quad& b) noexcept {
#    if XSIMD_WITH_AVX
    if constexpr (Quad::register_width == 4) {
        const __m256d x = a.in_register(0), y = b.in_register(0), pairs = _mm256_hadd_pd(x, y);
        return Narrow(_mm_add_pd(_mm256_castpd256_pd128(pairs), _mm256_extractf128_pd(pairs, 1)));
    }
#    endif
    if constexpr (Quad::register_width == 2) {
        const __m128d x = a.in_register(0) + a.in_register(1), y = b.in_register(0) + b.in_register(1);
        return Narrow(_mm_add_pd(_mm_unpacklo_pd(x, y), _mm_unpackhi_pd(x, y)));
    }
}
inline constexpr bool has_places = true;
#else
inline constexpr bool has_places = false;
template <class Narrow> void to_places(const Narrow&, double*, double*) noexcept {}
template <class Narrow> Narrow from_places(const double*, const double*) noexcept { return Narrow(); }
template <class Narrow, class Quad> Narrow sums_of_two(const Quad&, const Quad&) noexcept { return Narrow(); }
#endif

/// Two lanes in one register.
template <class Real>
inline constexpr bool is_pair = has_places&& lane_count<Real> == 2 && Real::register_width == 2;

/// Each lane to a place of its own: at(i) is that of lane i.
template <class Real, class At> [[gnu::always_inline]] inline void scatter(const Real& x, At&& at) noexcept {
    if constexpr (is_pair<Real>)
        to_places(x.in_register(0), at(std::size_t(0)), at(std::size_t(1)));
    else
        for (std::size_t i = 0; i < lane_count<Real>; ++i) *at(i) = x[i];
}
/// Each lane from a place of its own.
template <class Real, class At> [[gnu::always_inline]] inline Real gathered(At&& at) noexcept {
    if constexpr (is_pair<Real>)
        return Real::from_registers([&](std::size_t) {
            return from_places<typename Real::piece>(at(std::size_t(0)), at(std::size_t(1)));
        });
    else {
        std::array<double, lane_count<Real>> each;
        for (std::size_t i = 0; i < each.size(); ++i) each[i] = *at(i);
        return Real(each);
    }
}
/// The sum of four numbers in each lane, one row of four for each.
template <class Real, class Quad>
[[gnu::always_inline]] inline Real row_sums(const std::array<Quad, lane_count<Real>>& rows) noexcept {
    if constexpr (is_pair<Real> && (Quad::register_width == 2 || Quad::register_width == 4))
        return Real::from_registers(
            [&](std::size_t) { return sums_of_two<typename Real::piece>(rows[0], rows[1]); });
    else {
        std::array<double, lane_count<Real>> each;
        for (std::size_t i = 0; i < each.size(); ++i)
            each[i] = (rows[i][0] + rows[i][1]) + (rows[i][2] + rows[i][3]);
        return Real(each);
    }
}
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
/// The lanes of `low`, then those of `high`.
template <std::size_t W, class Isa>
lanes<2 * W, Isa> joined(const lanes<W, Isa>& low, const lanes<W, Isa>& high) noexcept {
    using wide = lanes<2 * W, Isa>;
    constexpr std::size_t narrow_width = lanes<W, Isa>::register_width, wide_width = wide::register_width;
    if constexpr (narrow_width == wide_width) {
        constexpr std::size_t registers = W / narrow_width;
        return wide::from_registers([&](std::size_t i) {
            return i < registers ? low.in_register(i) : high.in_register(i - registers);
        });
    } else if constexpr (detail::has_doubled && narrow_width == W && wide_width == 4 && narrow_width == 2)
        return wide::from_registers([&](std::size_t) {
            return detail::joined_registers<typename wide::piece>(low.in_register(0), high.in_register(0));
        });
    else {
        std::array<double, 2 * W> all;
        low.write(all.data());
        high.write(all.data() + W);
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

} // namespace quadrant::inline v0
