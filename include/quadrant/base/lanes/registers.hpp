// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../finite.hpp"
#include "instruction_set.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#if defined(__SSE2__) && __has_include(<xsimd/xsimd.hpp>)
#    include <xsimd/xsimd.hpp>
#endif

#ifdef XSIMD_HPP
namespace quadrant::inline v0::detail {
/// One of xsimd's sets with all extensions of the translation unit in its name: xsimd's own functions on it are
/// then distinguished by the linker too. Without FMA on purpose: with AVX2 the same results as with SSE2, also
/// of exp and sin.
template <class Set, unsigned Extensions> struct lane_set : Set {};
} // namespace quadrant::inline v0::detail

// How xsimd declares a set that has the registers of another (XSIMD_DECLARE_SIMD_REGISTER_ALIAS).
namespace xsimd::types {
template <class T, class Set, unsigned Extensions>
struct simd_register<T, quadrant::detail::lane_set<Set, Extensions>> : simd_register<T, Set> {
    using register_type = typename simd_register<T, Set>::register_type;
    simd_register() = default;
    simd_register(register_type reg) noexcept : simd_register<T, Set>{reg} {}
};
template <class T, class Set, unsigned Extensions>
struct has_simd_register<T, quadrant::detail::lane_set<Set, Extensions>> : has_simd_register<T, Set> {};
#    if XSIMD_WITH_AVX512F
template <class T, unsigned Extensions>
struct get_bool_simd_register<T, quadrant::detail::lane_set<avx512f, Extensions>>
    : get_bool_simd_register<T, avx512f> {};
#    endif
} // namespace xsimd::types

// The argument of sin and cos, brought near zero. xsimd's own way depends on the largest of the lanes and calls
// functions that are no templates, which the linker could not distinguish between sets; this one is each lane's
// own.
namespace xsimd::kernel::detail {
template <class Set, unsigned Extensions>
struct trigo_reducer<batch<double, quadrant::detail::lane_set<Set, Extensions>>, trigo_radian_tag> {
    using number = batch<double, quadrant::detail::lane_set<Set, Extensions>>;
    /// x = n pi/2 + rest, with pi/2 in three parts (fdlibm's); for 0 <= x <= mediumpi. Returns n modulo 4.
    static number reduce(const number& x, number& rest) noexcept {
        const number n = nearbyint(x * constants::twoopi<number>());
        const number first = x - n * constants::pio2_1<number>();
        number part = n * constants::pio2_2<number>();
        const number second = first - part;
        part = n * constants::pio2_2t<number>() - ((first - second) - part);
        const number small = n * constants::pio2_3<number>();
        const number third = second - small;
        part = n * constants::pio2_3t<number>() - ((second - third) - small);
        rest = third - part;
        return quadrant(n);
    }
};
} // namespace xsimd::kernel::detail
#endif

/// What the W numbers of a `lanes` are kept in: the widest registers that W fills, else doubles one by one.
namespace quadrant::inline v0::detail {

/// Doubles one by one: without xsimd, on another processor, or when W is odd.
template <std::size_t W, class Isa> struct lane_registers {
    static constexpr std::size_t width = 1;
    using number = double;
    using truth = bool;
};

#ifdef XSIMD_HPP
template <std::size_t W, unsigned Extensions> constexpr auto set_for() noexcept {
    if constexpr (W % 8 == 0 && (Extensions & isa::avx512f) != 0)
        return xsimd::avx512f();
    else if constexpr (W % 4 == 0 && (Extensions & isa::avx2) != 0)
        return xsimd::avx2();
    else if constexpr (W % 4 == 0 && (Extensions & isa::avx) != 0)
        return xsimd::avx();
    else if constexpr ((Extensions & isa::sse4_1) != 0)
        return xsimd::sse4_1();
    else
        return xsimd::sse2();
}

template <std::size_t W, unsigned Extensions>
requires(W % 2 == 0 && (Extensions & isa::xsimd) != 0) struct lane_registers<W, isa::x86<Extensions>> {
    using set = lane_set<decltype(set_for<W, Extensions>()), Extensions>;
    using number = xsimd::batch<double, set>;
    using truth = xsimd::batch_bool<double, set>;
    static constexpr std::size_t width = number::size;
};

template <class Set> xsimd::batch_bool<double, Set> is_finite(const xsimd::batch<double, Set>& x) noexcept {
    return xsimd::abs(x) <= xsimd::batch<double, Set>(std::numeric_limits<double>::max());
}
template <class Set>
xsimd::batch<double, Set> choose(const xsimd::batch_bool<double, Set>& c, const xsimd::batch<double, Set>& a,
                                 const xsimd::batch<double, Set>& b) noexcept {
    return xsimd::select(c, a, b);
}
template <class Set>
xsimd::batch_bool<double, Set> meet(const xsimd::batch_bool<double, Set>& a,
                                    const xsimd::batch_bool<double, Set>& b) noexcept {
    return a & b;
}
template <class Set>
xsimd::batch_bool<double, Set> join(const xsimd::batch_bool<double, Set>& a,
                                    const xsimd::batch_bool<double, Set>& b) noexcept {
    return a | b;
}
template <class Set> xsimd::batch_bool<double, Set> opposite(const xsimd::batch_bool<double, Set>& m) noexcept {
    return ~m; // xsimd's ! compares
}
/// True where xsimd's sin and cos hold: the rest is for the C library.
template <class Set> xsimd::batch_bool<double, Set> within_turns(const xsimd::batch<double, Set>& x) noexcept {
    return xsimd::abs(x) <= xsimd::constants::mediumpi<xsimd::batch<double, Set>>();
}
template <class Set> bool any_of(const xsimd::batch_bool<double, Set>& m) noexcept { return xsimd::any(m); }
template <class Set> bool all_of(const xsimd::batch_bool<double, Set>& m) noexcept { return xsimd::all(m); }
template <class Set> void put(const xsimd::batch<double, Set>& x, double* out) noexcept {
    x.store_unaligned(out);
}
template <class Set> void put(const xsimd::batch_bool<double, Set>& m, bool* out) noexcept {
    m.store_unaligned(out);
}
template <class Set> void get(xsimd::batch<double, Set>& x, const double* in) noexcept {
    x = xsimd::batch<double, Set>::load_unaligned(in);
}
template <class Set> void get(xsimd::batch_bool<double, Set>& m, const bool* in) noexcept {
    m = xsimd::batch_bool<double, Set>::load_unaligned(in);
}
#endif

#ifdef XSIMD_HPP
template <class Set>
xsimd::batch<double, Set> turned_as(const xsimd::batch<double, Set>& a,
                                    const xsimd::batch<double, Set>& b) noexcept {
    return a ^ xsimd::bitofsign(b);
}
#endif
#ifdef XSIMD_HPP
template <class Set>
xsimd::batch<double, Set> bits_joined(const xsimd::batch<double, Set>& a,
                                      const xsimd::batch<double, Set>& b) noexcept {
    return a | b;
}
/// p 2^k, where k are the lowest bits of `shifted`; by adding to the exponent.
template <class Set>
xsimd::batch<double, Set> scaled_by_bits(const xsimd::batch<double, Set>& p,
                                         const xsimd::batch<double, Set>& shifted) noexcept {
    using whole = xsimd::batch<std::int64_t, Set>;
    return xsimd::bitwise_cast<xsimd::batch<double, Set>>(whole(xsimd::bitwise_cast<whole>(p)) +
                                                          (xsimd::bitwise_cast<whole>(shifted) << 52));
}
#endif
#ifdef XSIMD_HPP
/// x, or the bound that it lies beyond; x where it is no number: the processor gives the second one then.
template <class Set>
xsimd::batch<double, Set> not_above(const xsimd::batch<double, Set>& most,
                                    const xsimd::batch<double, Set>& x) noexcept {
    return xsimd::min(most, x);
}
template <class Set>
xsimd::batch<double, Set> not_below(const xsimd::batch<double, Set>& lowest,
                                    const xsimd::batch<double, Set>& x) noexcept {
    return xsimd::max(lowest, x);
}
#endif
constexpr double not_above(double most, double x) noexcept { return x > most ? most : x; }
constexpr double not_below(double lowest, double x) noexcept { return x < lowest ? lowest : x; }
inline double bits_joined(double a, double b) noexcept {
    return bits_as<double>(bits_as<std::uint64_t>(a) | bits_as<std::uint64_t>(b));
}
inline double scaled_by_bits(double p, double shifted) noexcept {
    return bits_as<double>(bits_as<std::uint64_t>(p) + (bits_as<std::uint64_t>(shifted) << 52));
}
inline double turned_as(double a, double b) noexcept { return std::signbit(b) ? -a : a; }

/// Lanes in step lie in the registers of their set.
template <std::size_t W, class Isa> struct lane_registers<W, isa::in_step<Isa>> : lane_registers<W, Isa> {};

constexpr double choose(bool c, double a, double b) noexcept { return c ? a : b; }
constexpr bool meet(bool a, bool b) noexcept { return a && b; }
constexpr bool opposite(bool m) noexcept { return !m; }
constexpr bool join(bool a, bool b) noexcept { return a || b; }
constexpr bool within_turns(double) noexcept { return true; } // std::sin and std::cos hold everywhere
constexpr bool any_of(bool m) noexcept { return m; }
constexpr bool all_of(bool m) noexcept { return m; }
template <class Plain> constexpr void put(Plain x, Plain* out) noexcept { *out = x; }
template <class Plain> constexpr void get(Plain& x, const Plain* in) noexcept { x = *in; }

} // namespace quadrant::inline v0::detail
