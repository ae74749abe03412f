// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/signal.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <numbers>

/// The model that an observer compares the axis with.
namespace quadrant {

/// Any rational plant without delay, bare numbers in SI by rising power of s (as in discretize.hpp); the
/// highest of both not zero. Zeros is the degree of the numerator, Order - Zeros the relative degree.
template <std::size_t Order, std::size_t Zeros = 0, class Number = double> struct nominal_plant {
    static_assert(Zeros <= Order, "a plant cannot look ahead");
    std::array<Number, Zeros + 1> numerator{};
    std::array<Number, Order + 1> denominator{};
};

/// A mass that a motor drives against viscous friction, from command to position: Gn(s) = B / (s (s + A)).
/// Source: [Jamaludin2008] eq. (2.2) without its delay. Converts to a `nominal_plant<2>`.
template <signal_tag Command, class Number = double> struct axis_model {
    gain_of<signal::acceleration, Command, Number> gain; ///< B: acceleration per command
    quantity<si::frequency, Number> damping{};           ///< A: viscous friction over mass, in 1/s (not hertz)

    constexpr operator nominal_plant<2, 0, Number>() const {
        return {{gain.value()}, {Number(0), damping.value(), Number(1)}};
    }
};

} // namespace quadrant
