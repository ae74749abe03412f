// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "cubic_weights.hpp"

#include <array>
#include <cmath>
#include <cstddef>

/// What a repetitive memory in one lane and in several works out in the same way: which samples it reads, and
/// what it holds at rest.
namespace quadrant::inline v0::detail {

template <std::size_t Order, std::size_t LearningTaps, std::size_t SmoothingTaps>
concept repeats = Order >= 1 && LearningTaps >= 1 && SmoothingTaps % 2 == 1;

/// The smoothing that changes nothing.
template <class Number, std::size_t Taps> constexpr std::array<Number, Taps> only_the_middle() {
    std::array<Number, Taps> q{};
    q[Taps / 2] = Number(1);
    return q;
}
/// Which samples of p make r, and how much of each.
template <class Real, std::size_t Order> struct memory_reader {
    std::array<std::size_t, Order> oldest{}; ///< of the four: how far before the coming p
    std::array<std::array<Real, 4>, Order> weight{};

    /// For a cycle of so many periods, `shortest` to `most`.
    template <class Number>
    static memory_reader at(Number periods, const std::array<Number, Order>& weights, std::size_t shortest,
                            std::size_t most) noexcept {
        const Number low{double(shortest)}, high{double(most)};
        if (plain(periods) < plain(low)) periods = low; // by rounding
        if (plain(periods) > plain(high)) periods = high;
        memory_reader out;
        for (std::size_t i = 0; i < Order; ++i) {
            const Number delay = Number(double(i + 1)) * periods;
            const double whole = std::floor(plain(delay));
            const auto cubic = cubic_weights(Number(delay - Number(whole)));
            out.oldest[i] = std::size_t(whole) - shortest + 4;
            for (std::size_t j = 0; j < 4; ++j) out.weight[i][j] = Real(weights[i] * cubic[j]);
        }
        return out;
    }
};

/// How far the sum of a Q and weights that let nothing through may lie from 1 by rounding.
template <class Real> constexpr double rounding_of_a_sum(std::size_t taps) noexcept {
    return 16 * double(taps) * (sizeof(Real) < sizeof(double) ? 6e-8 : 1.1e-16);
}
/// What a memory at rest holds: m = e + r, r, and its output.
template <class Value> struct memory_level { Value m{}, r{}, y{}; };
/// At the input x, or, where any output may stand at one input or `has_output`, at the output y. `gain`: sum of
/// L; g: of Q and the weights, 1 within `rounding` where any output may stand.
template <class Value, class Real>
memory_level<Value> memory_at_rest(Value x, Value y, bool has_output, const Real& gain, const Real& g,
                                   double rounding) noexcept {
    const bool any_output = std::abs(plain(g) - 1) <= rounding;
    if ((has_output || any_output) && plain(gain) != 0 && plain(g) != 0) {
        const Value r = y / gain;
        return {r / g, r, y};
    }
    if (any_output) return {};
    const Value r = g / (Real(1) - g) * x;
    return {x + r, r, gain * r};
}

} // namespace quadrant::inline v0::detail
