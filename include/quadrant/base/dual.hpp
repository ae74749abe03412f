// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace quadrant::inline v0 {

/// A number that carries its derivatives by N parameters: run a whole loop with it and read how every wire
/// moves with them. Eager (no expression templates), so that it fits into a quantity. Comparisons look at the
/// value only; at a switch (stick, limit) the derivative is that of the branch taken.
template <std::size_t N, std::floating_point Real = double> struct dual {
    Real value = 0;
    std::array<Real, N> partial{};

    constexpr dual() = default;
    template <class Number>
    requires std::is_arithmetic_v<Number>
    constexpr dual(Number v) noexcept : value(static_cast<Real>(v)) {}

    /// The parameter number `which`, with unit derivative.
    static constexpr dual variable(Real v, std::size_t which) noexcept {
        dual d(v);
        d.partial[which] = 1;
        return d;
    }
    /// f(x) with its slope f'(x).
    constexpr dual chain(Real f, Real slope) const noexcept {
        dual d(f);
        for (std::size_t i = 0; i < N; ++i) d.partial[i] = slope * partial[i];
        return d;
    }

    constexpr dual& operator+=(const dual& o) noexcept {
        value += o.value;
        for (std::size_t i = 0; i < N; ++i) partial[i] += o.partial[i];
        return *this;
    }
    constexpr dual& operator-=(const dual& o) noexcept {
        value -= o.value;
        for (std::size_t i = 0; i < N; ++i) partial[i] -= o.partial[i];
        return *this;
    }
    constexpr dual& operator*=(const dual& o) noexcept {
        for (std::size_t i = 0; i < N; ++i) partial[i] = partial[i] * o.value + value * o.partial[i];
        value *= o.value;
        return *this;
    }
    constexpr dual& operator/=(const dual& o) noexcept {
        value /= o.value;
        for (std::size_t i = 0; i < N; ++i) partial[i] = (partial[i] - value * o.partial[i]) / o.value;
        return *this;
    }

    friend constexpr dual operator+(dual a, const dual& b) noexcept { return a += b; }
    friend constexpr dual operator-(dual a, const dual& b) noexcept { return a -= b; }
    friend constexpr dual operator*(dual a, const dual& b) noexcept { return a *= b; }
    friend constexpr dual operator/(dual a, const dual& b) noexcept { return a /= b; }
    friend constexpr dual operator-(const dual& a) noexcept { return a.chain(-a.value, -1); }
    friend constexpr dual operator+(const dual& a) noexcept { return a; }

    friend constexpr bool operator==(const dual& a, const dual& b) noexcept { return a.value == b.value; }
    friend constexpr auto operator<=>(const dual& a, const dual& b) noexcept { return a.value <=> b.value; }

    friend dual abs(const dual& x) noexcept { return x.value < 0 ? -x : x; }
    friend dual sqrt(const dual& x) noexcept {
        const Real root = std::sqrt(x.value);
        return x.chain(root, Real(0.5) / root);
    }
    friend dual exp(const dual& x) noexcept {
        const Real e = std::exp(x.value);
        return x.chain(e, e);
    }
    friend dual log(const dual& x) noexcept { return x.chain(std::log(x.value), 1 / x.value); }
    friend dual sin(const dual& x) noexcept { return x.chain(std::sin(x.value), std::cos(x.value)); }
    friend dual cos(const dual& x) noexcept { return x.chain(std::cos(x.value), -std::sin(x.value)); }
    friend dual tan(const dual& x) noexcept {
        const Real t = std::tan(x.value);
        return x.chain(t, 1 + t * t);
    }
    /// A rounded value moves in steps: the slope is that of the identity, as for a quantizer seen from afar.
    friend dual round(const dual& x) noexcept { return x.chain(std::round(x.value), 1); }
};

} // namespace quadrant::inline v0
