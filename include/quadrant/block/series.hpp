// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "maps.hpp"

#include <complex>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace quadrant::inline v0 {

namespace detail {
/// What stands in a series behind this first block: it maps the same signal, and says its state.
template <class Box, class First>
concept in_series_with = maps<Box, typename First::input, typename First::input, real_of<First>> &&
    requires(Box& box, const Box& as_it_is) {
    typename Box::parameters;
    box.reset();
    as_it_is.now();
};
} // namespace detail

/// Several blocks of one signal behind one another, in the order of the list: two notches, a notch and a
/// low-pass.
///   y = last(... second(first(x)))
/// Ports: one scalar in, one scalar out, the same signal for all.
/// State: that of the blocks, now() as a tuple; `reset` resets, `settle(x)` settles each at what the one before
/// gives. `retune(next)` and `shift(by)` where each block has them.
/// NaN and infinities: a bad input reaches no block, the last output is held; a block that overflows holds its
/// own, the ones behind it go on. faulted() = any of that has happened.
/// Throws what the blocks throw.
/// Cost: that of the blocks. Sums and feedback are not a series: write them as lines of a struct, see
/// `cascade`.
template <class First, class... Rest>
requires detail::in_series_with<First, First> &&(detail::in_series_with<Rest, First>&&...) class series {
public:
    using input = typename First::input;
    using output = input;
    using argument = quantity_of<input, real_of<First>>;
    using value = argument;
    using number = parameter_real<real_of<First>>; ///< of parameters

    using parameters = std::tuple<typename First::parameters, typename Rest::parameters...>;
    using state = std::tuple<std::decay_t<decltype(std::declval<const First&>().now())>,
                             std::decay_t<decltype(std::declval<const Rest&>().now())>...>;

    series(const parameters& p, duration period)
        : series(p, period, std::index_sequence_for<First, Rest...>()) {}

    value operator()(value x) noexcept {
        const auto good = finite(x);
        if (none(good)) return out_.hold();
        std::apply([&](auto&... block) { ((x = block(only_where(good, x))), ...); }, blocks_);
        return out_.keep(good, x);
    }
    void reset() noexcept {
        out_.reset();
        std::apply([](auto&... block) { (block.reset(), ...); }, blocks_);
    }
    void settle(value x) noexcept {
        const auto good = finite(x);
        if (none(good)) return out_.raise();
        std::apply([&](auto&... block) { ((x = detail::settled(block, only_where(good, x))), ...); }, blocks_);
        out_.settle(good, x);
    }
    void retune(const series& next) noexcept requires(retunable<First>&&...&& retunable<Rest>) {
        retune_each(next, std::index_sequence_for<First, Rest...>());
    }
    void shift(value by) noexcept ///< where each block has gain one at standstill
        requires(shiftable<First, input>&&...&& shiftable<Rest, input>) {
        const auto good = finite(by);
        if (none(good)) return out_.raise();
        std::apply([&](auto&... block) { (block.shift(by), ...); }, blocks_);
        out_.keep(good, out_.last() + by);
    }

    /// Of all blocks together, where each has one.
    std::complex<double> response(frequency f) const
        requires(detail::responds<First> && (detail::responds<Rest> && ...)) {
        return std::apply([&](const auto&... block) { return (block.response(f) * ...); }, blocks_);
    }
    bool faulted() const noexcept {
        return out_.faulted() ||
               std::apply([](const auto&... block) { return (detail::is_faulted(block) || ...); }, blocks_);
    }
    mask_of<real_of<First>> faulted_lanes() const noexcept {
        auto out = out_.faulted_lanes();
        std::apply([&](const auto&... block) { ((out = either(out, block.faulted_lanes())), ...); }, blocks_);
        return out;
    }
    parameters given() const noexcept {
        return std::apply([](const auto&... block) { return parameters(block.given()...); }, blocks_);
    }
    state now() const noexcept {
        return std::apply([](const auto&... block) { return state(block.now()...); }, blocks_);
    }

private:
    using blocks = std::tuple<First, Rest...>;
    template <std::size_t... I>
    series(const parameters& p, duration period, std::index_sequence<I...>)
        : blocks_(std::tuple_element_t<I, blocks>(std::get<I>(p), period)...) {}

    template <std::size_t... I> void retune_each(const series& next, std::index_sequence<I...>) noexcept {
        (detail::retune(std::get<I>(blocks_), std::get<I>(next.blocks_)), ...);
    }

    blocks blocks_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
