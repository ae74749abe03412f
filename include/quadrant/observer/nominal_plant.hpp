// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/signal.hpp"

#include <array>
#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>

/// The model that an observer compares the axis with.
namespace quadrant::inline v0 {

/// Any rational plant without delay, bare numbers in SI by rising power of s (as in discretize.hpp); the
/// highest of both not zero. Zeros is the degree of the numerator, Order - Zeros the relative degree.
template <std::size_t Order, std::size_t Zeros = 0, class Number = double> struct nominal_plant {
    static_assert(Zeros <= Order, "a plant cannot look ahead");
    std::array<Number, Zeros + 1> numerator{};
    std::array<Number, Order + 1> denominator{};

    constexpr nominal_plant() = default;
    /// nominal_plant<2, 1>{{600, 3}, {0, 345, 1}}: every coefficient of both is written. Two bare numbers are
    /// no plant, so that {1.9, 4.6} does not pass for an `axis_model`.
    template <std::size_t Above, std::size_t Below>
    requires(Above == Zeros + 1 && Below == Order + 1) constexpr nominal_plant(const Number (&above)[Above],
                                                                               const Number (&below)[Below])
        : numerator(std::to_array(above)), denominator(std::to_array(below)) {}
    /// From two whole arrays.
    template <std::same_as<std::array<Number, Zeros + 1>> Above,
              std::same_as<std::array<Number, Order + 1>> Below>
    constexpr nominal_plant(const Above& above, const Below& below) : numerator(above), denominator(below) {}
};

/// A mass that a motor drives against viscous friction, from command to position: Gn(s) = B / (s (s + A)).
/// Source: [Jamaludin2008] eq. (2.2) without its delay. Converts to a `nominal_plant<2>`.
template <signal_tag Command, class Number = double> struct axis_model {
    gain_of<signal::acceleration, Command, Number> gain; ///< B: acceleration per command
    quantity<si::frequency, Number> viscous_rate{};      ///< A: viscous friction over mass, in 1/s (not hertz)

    constexpr operator nominal_plant<2, 0, Number>() const {
        return {{gain.value()}, {Number(0), viscous_rate.value(), Number(1)}};
    }
};

} // namespace quadrant::inline v0
