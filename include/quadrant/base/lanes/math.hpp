// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fine_sum.hpp"
#include "number.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <type_traits>

/// The functions of <cmath> on lanes, found by argument-dependent lookup as those of `dual` are. In registers
/// exp, log, sin and cos are xsimd's; docs/lanes.md says how far they lie from the C library's. tan, atan2 and
/// pow call the C
/// library lane by lane: a filter designed with them has the coefficients of its scalar twin, bit for bit.
namespace quadrant::inline v0 {

/// Without its sign, as std::abs.
template <std::size_t W, class Isa> lanes<W, Isa> abs(const lanes<W, Isa>& x) noexcept {
    return lanes<W, Isa>::map(
        [](const auto& v) {
            using std::abs;
            return abs(v);
        },
        x);
}
/// As std::sqrt, bit for bit.
template <std::size_t W, class Isa> lanes<W, Isa> sqrt(const lanes<W, Isa>& x) noexcept {
    return lanes<W, Isa>::map(
        [](const auto& v) {
            using std::sqrt;
            return sqrt(v);
        },
        x);
}
/// xsimd's in registers; the C library's in a lane beyond +-708, where the result is no normal number (an
/// infinity and a NaN too: without SSE4 xsimd would turn them into integers).
template <std::size_t W, class Isa> lanes<W, Isa> exp(const lanes<W, Isa>& x) noexcept {
    const auto near = less_equal(abs(x), lanes<W, Isa>(708));
    lanes<W, Isa> y = lanes<W, Isa>::map(
        [](const auto& v) {
            using std::exp;
            return exp(v);
        },
        all(near) ? x : select(near, x, lanes<W, Isa>()));
    if (!all(near))
        for (std::size_t i = 0; i < W; ++i)
            if (!near[i]) y.set(i, std::exp(x[i]));
    return y;
}
/// exp(-x) for x >= 0, within one unit in the last place; beyond 708, where it is no normal number any more,
/// that of 708. 2^-k from the bits and a polynomial of the rest (SLEEF's, https://sleef.org): a third of the
/// work of `exp`, and the same on every instruction set. A single lane has the C library's, which is faster
/// there.
template <std::size_t W, class Isa>
[[gnu::always_inline]] inline lanes<W, Isa> decayed(const lanes<W, Isa>& x) noexcept {
    using number = lanes<W, Isa>;
    if constexpr (W == 1) return number(std::exp(-(x[0] > 708 ? 708 : x[0])));
    const number shift(0x1.8p52), y = clipped_above(x, number(708));
    const number shifted = detail::rounded_here<number>(shift - y * number(1.442695040888963407359924681));
    const number k = shifted - shift;
    const number r = (k * number(-.69314718055966295651160180568695068359375) - y) +
                     k * number(-.28235290563031577122588448175013436025525412068e-12);
    const number r2 = r * r, r4 = r2 * r2;
    const auto term = [&r](double low, double high) { return number(low) + r * number(high); };
    const number low = term(0.5, 0.166666666666666851703837),
                 next = term(0.0416666666666665047591422, 0.00833333333331652721664984),
                 more = term(0.00138888888889774492207962, 0.000198412698960509205564975),
                 high = term(2.4801587159235472998791e-05, 2.75572362911928827629423e-06),
                 last = term(2.75573911234900471893338e-07, 2.51112930892876518610661e-08) +
                        r2 * number(2.08860621107283687536341e-09);
    const number p = (low + r2 * next) + r4 * ((more + r2 * high) + r4 * last);
    return scaled_by_bits(number(1) + (r + r2 * p), shifted);
}
/// xsimd's in registers.
template <std::size_t W, class Isa> lanes<W, Isa> log(const lanes<W, Isa>& x) noexcept {
    return lanes<W, Isa>::map(
        [](const auto& v) {
            using std::log;
            return log(v);
        },
        x);
}
/// xsimd's in registers; the C library's in a lane beyond 2^18 pi/2.
template <std::size_t W, class Isa> lanes<W, Isa> sin(const lanes<W, Isa>& x) noexcept {
    const auto near = within_turns(x);
    lanes<W, Isa> y = lanes<W, Isa>::map(
        [](const auto& v) {
            using std::sin;
            return sin(v);
        },
        all(near) ? x : select(near, x, lanes<W, Isa>()));
    if (!all(near))
        for (std::size_t i = 0; i < W; ++i)
            if (!near[i]) y.set(i, std::sin(x[i]));
    return y;
}
/// xsimd's in registers; the C library's in a lane beyond 2^18 pi/2.
template <std::size_t W, class Isa> lanes<W, Isa> cos(const lanes<W, Isa>& x) noexcept {
    const auto near = within_turns(x);
    lanes<W, Isa> y = lanes<W, Isa>::map(
        [](const auto& v) {
            using std::cos;
            return cos(v);
        },
        all(near) ? x : select(near, x, lanes<W, Isa>()));
    if (!all(near))
        for (std::size_t i = 0; i < W; ++i)
            if (!near[i]) y.set(i, std::cos(x[i]));
    return y;
}
/// std::tan, lane by lane.
template <std::size_t W, class Isa> lanes<W, Isa> tan(const lanes<W, Isa>& x) noexcept {
    return lanes<W, Isa>::one_by_one([](double v) { return std::tan(v); }, x);
}
namespace detail {
/// Rounds in registers what has a fraction. From 2^52 on a number is whole, and an infinity or a NaN stays:
/// without SSE4 xsimd would turn them into integers.
template <std::size_t W, class Isa, class Round>
lanes<W, Isa> rounded(const lanes<W, Isa>& x, const Round& round) noexcept {
    const auto has_fraction = less(abs(x), lanes<W, Isa>(0x1p52));
    if (all(has_fraction)) return lanes<W, Isa>::map(round, x);
    return select(has_fraction, lanes<W, Isa>::map(round, select(has_fraction, x, lanes<W, Isa>())), x);
}
} // namespace detail

/// As std::floor.
template <std::size_t W, class Isa> lanes<W, Isa> floor(const lanes<W, Isa>& x) noexcept {
    const auto floored = [](const auto& v) {
        using std::floor;
        return floor(v);
    };
    if constexpr (isa::rounds_in_registers<Isa>)
        return lanes<W, Isa>::map(floored, x);
    else
        return detail::rounded(x, floored);
}
template <std::size_t W, class Isa> lanes<W, Isa> trunc(const lanes<W, Isa>& x) noexcept;
/// Halves away from zero, as std::round.
template <std::size_t W, class Isa> lanes<W, Isa> round(const lanes<W, Isa>& x) noexcept {
    // Away from zero by the largest number below a half, then towards zero: as std::round, bit for bit.
    return trunc(x + turned_as(lanes<W, Isa>(0x1.fffffffffffffp-2), x));
}
/// The nearest whole number, halves to the even one; where a register does it in one instruction, else as
/// round.
template <std::size_t W, class Isa> lanes<W, Isa> nearest(const lanes<W, Isa>& x) noexcept {
    const auto to_nearest = [](const auto& v) {
        using std::nearbyint;
        return nearbyint(v);
    };
    if constexpr (isa::rounds_in_registers<Isa>)
        return lanes<W, Isa>::map(to_nearest, x);
    else
        return round(x);
}
/// As std::trunc.
template <std::size_t W, class Isa> lanes<W, Isa> trunc(const lanes<W, Isa>& x) noexcept {
    const auto truncated = [](const auto& v) {
        using std::trunc;
        return trunc(v);
    };
    if constexpr (isa::rounds_in_registers<Isa>)
        return lanes<W, Isa>::map(truncated, x);
    else
        return detail::rounded(x, truncated);
}
/// std::atan2, lane by lane.
template <std::size_t W, class Isa>
lanes<W, Isa> atan2(const lanes<W, Isa>& y, const std::type_identity_t<lanes<W, Isa>>& x) noexcept {
    return lanes<W, Isa>::one_by_one([](double a, double b) { return std::atan2(a, b); }, y, x);
}
/// std::pow, lane by lane.
template <std::size_t W, class Isa>
lanes<W, Isa> pow(const lanes<W, Isa>& x, const std::type_identity_t<lanes<W, Isa>>& y) noexcept {
    return lanes<W, Isa>::one_by_one([](double a, double b) { return std::pow(a, b); }, x, y);
}
/// As std::copysign.
template <std::size_t W, class Isa>
lanes<W, Isa> copysign(const lanes<W, Isa>& x, const std::type_identity_t<lanes<W, Isa>>& sign) noexcept {
    return lanes<W, Isa>::map(
        [](const auto& a, const auto& b) {
            using std::copysign;
            return copysign(a, b);
        },
        x, sign);
}
/// As std::min, also of NaN.
template <std::size_t W, class Isa>
lanes<W, Isa> min(const lanes<W, Isa>& a, const std::type_identity_t<lanes<W, Isa>>& b) noexcept {
    return select(less(b, a), b, a);
}
/// As std::max, also of NaN.
template <std::size_t W, class Isa>
lanes<W, Isa> max(const lanes<W, Isa>& a, const std::type_identity_t<lanes<W, Isa>>& b) noexcept {
    return select(less(a, b), b, a);
}
/// As std::clamp, also of NaN.
template <std::size_t W, class Isa>
lanes<W, Isa> clamp(const lanes<W, Isa>& x, const std::type_identity_t<lanes<W, Isa>>& low,
                    const std::type_identity_t<lanes<W, Isa>>& high) noexcept {
    return select(less(x, low), low, select(less(high, x), high, x));
}

} // namespace quadrant::inline v0
