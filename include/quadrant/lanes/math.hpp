// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "number.hpp"

#include <cmath>

/// The functions of <cmath> on lanes, found by argument-dependent lookup as those of `dual` are. In registers exp, log,
/// sin and cos are xsimd's; docs/lanes.md says how far they lie from the C library's. tan, atan2 and pow call the C
/// library lane by lane: a filter designed with them has the coefficients of its scalar twin, bit for bit.
namespace quadrant {

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
/// xsimd's in registers; the C library's in a lane beyond +-708, where the result is no normal number (an infinity and a NaN too:
/// without SSE4 xsimd would turn them into integers).
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
/// Rounds in registers what has a fraction. From 2^52 on a number is whole, and an infinity or a NaN stays: without SSE4
/// xsimd would turn them into integers.
template <std::size_t W, class Isa, class Round>
lanes<W, Isa> rounded(const lanes<W, Isa>& x, const Round& round) noexcept {
    const auto has_fraction = less(abs(x), lanes<W, Isa>(0x1p52));
    if (all(has_fraction)) return lanes<W, Isa>::map(round, x);
    return select(has_fraction, lanes<W, Isa>::map(round, select(has_fraction, x, lanes<W, Isa>())), x);
}
} // namespace detail

/// As std::floor.
template <std::size_t W, class Isa> lanes<W, Isa> floor(const lanes<W, Isa>& x) noexcept {
    return detail::rounded(x, [](const auto& v) {
        using std::floor;
        return floor(v);
    });
}
/// Halves away from zero, as std::round.
template <std::size_t W, class Isa> lanes<W, Isa> round(const lanes<W, Isa>& x) noexcept {
    return detail::rounded(x, [](const auto& v) {
        using std::round;
        return round(v);
    });
}
/// As std::trunc.
template <std::size_t W, class Isa> lanes<W, Isa> trunc(const lanes<W, Isa>& x) noexcept {
    return detail::rounded(x, [](const auto& v) {
        using std::trunc;
        return trunc(v);
    });
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

} // namespace quadrant
