// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "finite.hpp"

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

/// An axis that stands still must cost no more than one that moves, and what has died out must be zero. A
/// recursive filter alone halves its state for ever; below 1e-308 (float: 1e-38) the processor then computes
/// with subnormal numbers, slowly.
namespace quadrant::inline v0 {

namespace detail {
/// The part of a number's bits that is zero below 2^-895 (float: 2^-63). Nothing is left of a signal in SI
/// below that, and a product with any coefficient of a filter is still a normal number. By bits: the values of
/// several numbers are tested at once.
constexpr std::uint64_t large_bits(double x) noexcept {
    return bits_as<std::uint64_t>(x) & 0x7800'0000'0000'0000;
}
constexpr std::uint32_t large_bits(float x) noexcept { return bits_as<std::uint32_t>(x) & 0x6000'0000; }
template <carries_partials Dual> constexpr auto large_bits(const Dual& x) noexcept {
    auto all = large_bits(x.value);
    for (const auto& p : x.partial) all |= large_bits(p);
    return all;
}
inline constexpr double least = 0x1p-895;
template <class Value> using bare_of = std::remove_cvref_t<decltype(bare(std::declval<const Value&>()))>;

template <carries_partials Dual>
constexpr Dual without_tiny(const Dual& of) noexcept { // value and derivatives die out each for itself
    Dual x = of;
    if (large_bits(x.value) == 0) x.value = 0;
    for (auto& p : x.partial)
        if (large_bits(p) == 0) p = 0;
    return x;
}
template <multi_lane Lanes> Lanes without_tiny(const Lanes& x) noexcept {
    return select(less(absolute(x), Lanes(least)), Lanes(0), x);
}
template <std::floating_point Real> constexpr Real without_tiny(const Real& x) noexcept {
    return large_bits(x) == 0 ? Real(0) : x;
}
template <class Unit, class Real>
constexpr quantity<Unit, Real> without_tiny(const quantity<Unit, Real>& x) noexcept {
    return quantity<Unit, Real>::from_value(without_tiny(x.value()));
}
} // namespace detail

/// True where every argument has died out: nothing but the rest of a decay (2^-895 in SI, 2^-63 in float). Of a
/// dual also its derivatives.
template <class Value, class... More>
requires(!multi_lane<detail::bare_of<Value>>) constexpr bool died_out(const Value& x,
                                                                      const More&... more) noexcept {
    return (detail::large_bits(detail::bare(x)) | ... | detail::large_bits(detail::bare(more))) == 0;
}
/// The same, lane by lane.
template <class Value, class... More>
requires multi_lane<detail::bare_of<Value>>
auto died_out(const Value& x, const More&... more) noexcept {
    auto bits = detail::bare(x);
    ((bits = bits_joined(bits, detail::bare(more))), ...);
    return less(absolute(bits), detail::bare_of<Value>(detail::least)); // which is a power of two
}
/// x, and zero where x has died out: what a state with one pole stores.
template <class Value> constexpr Value unless_died_out(const Value& x) noexcept {
    return detail::without_tiny(x);
}

} // namespace quadrant::inline v0
