// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/fine_sum.hpp"
#include "../base/standstill.hpp"
#include "pole_mapping.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>

/// Sampled filters as chains of integrators, in powers of D = z - 1 instead of z. Where a pole is slow, z lies
/// so close to 1 that a
/// coefficient in z holds it in its last digits only: of order n it loses (pole T)^n. In D every coefficient is
/// small for itself and keeps all its digits. Source: [Middleton1990]. Derivation:
/// docs/derivations/second_order.md.
namespace quadrant::inline v0 {

/// Coefficients of a sampled filter by rising power of 1/D, bare numbers in SI:
///   (numerator[0] D^n + ... + numerator[n]) / (denominator[0] D^n + ... + denominator[n])
template <std::size_t Order, class Number = double> struct differences {
    std::array<Number, Order + 1> numerator{}, denominator{};
};

namespace detail {

/// sum p[i] z^(n-i) as sum q[i] (z - 1)^(n-i), or with the sign -1 from D back to z.
template <std::size_t Size, class Number>
std::array<Number, Size> about_one(std::array<Number, Size> p, double one = 1) {
    for (std::size_t last = Size; last > 1; --last)
        for (std::size_t i = 1; i < last; ++i) p[i] += one * p[i - 1];
    return p;
}

/// k^-Order sum c_i s^i with s = k (z - 1)/(z + 1), times (z + 1)^Order: the bilinear form of one polynomial of
/// a common fraction, by rising power of 1/D. With `differences` the factor 1 - z^-1 is left out (c_0 is then
/// zero) and the caller feeds differences. All terms of a polynomial with coefficients of one sign are of one
/// sign: nothing cancels.
template <std::size_t Order, std::size_t Size, class Number>
std::array<Number, Order + 1> bilinear_differences(const std::array<Number, Size>& c, double k,
                                                   bool differences) {
    static_assert(Size <= Order + 1);
    std::array<Number, Order + 1> sum{};
    for (std::size_t i = differences ? 1 : 0; i < Size; ++i) {
        std::array<Number, Order + 1>
            p{}; // D^i (D + 2)^(Order - i); with differences D^(i-1) (D + 1) (D + 2)^(Order - i)
        p[0] = 1;
        for (std::size_t j = i; j < Order; ++j) multiply(p, 2.0);
        if (differences) multiply(p, 1.0);
        const double power = std::pow(k, double(i) - double(Order));
        for (std::size_t j = 0; j <= Order; ++j) sum[j] += c[i] * power * p[j];
    }
    return sum;
}

/// p[0] D^n + ... + p[n] at z = exp(j angle), without loss where the angle is small.
template <std::size_t Size, class Coefficient>
std::complex<double> in_differences(const std::array<Coefficient, Size>& p, double angle) {
    const std::complex<double> d =
        std::complex<double>(0, 2 * std::sin(angle / 2)) * std::polar(1.0, angle / 2);
    std::complex<double> y = 0;
    for (const auto& c : p) y = y * d + plain(c);
    return y;
}

/// The integrators of a filter: fine sums in float, plain ones in every other number type.
template <class Value, class Real, std::size_t Order>
using integrators = std::array<fine_sum<Value, std::same_as<Real, float>>, Order>;

/// Sets a chain of integrators to zero where it, its output and everything around it have died out.
template <class Integrators, class Output, class... Values>
void rest_if_died_out(Integrators& s, const Output& y, const Values&... around) noexcept {
    if (none(died_out(y))) return; // nearly always
    auto still = died_out(y, around...);
    for (const auto& each : s) still = both(still, died_out(each.high));
    if (none(still)) return;
    for (auto& each : s) set_where(still, each, {});
}

} // namespace detail

} // namespace quadrant::inline v0
