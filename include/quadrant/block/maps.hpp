// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/signal.hpp"

#include <concepts>
#include <type_traits>

namespace quadrant::inline v0 {

namespace detail {
template <class Block> struct real_of_block { using type = double; };
template <class Block>
requires requires { typename Block::value::value_type; }
struct real_of_block<Block> {
    using type = typename Block::value::value_type;
};
} // namespace detail

/// The number type of a block; double for one that does not say.
template <class Block> using real_of = typename detail::real_of_block<Block>::type;

/// Calling B with In's quantity gives Out's, and B can be reset: all that a box must do to sit between two
/// wires. A type with these two members is a box; nothing to derive from. (No noexcept here: a quantity's copy
/// is not.)
template <class B, class In, class Out, class Real = real_of<B>>
concept maps = signal_tag<In> && signal_tag<Out> && requires(B b, const quantity_of<In, Real>& x) {
    { b(x) } -> std::same_as<quantity_of<Out, Real>>;
    b.reset();
};

/// B takes the parameters of another B while it runs, or has none.
template <class B>
concept retunable = std::is_empty_v<typename B::parameters> || requires(B b, const B& next) {
    b.retune(next);
};
/// B takes the parameters of another B while it runs, and is told at which input it shall give which output.
template <class B, class In, class Out, class Real = real_of<B>>
concept retunable_at = requires(B b, const B& next, quantity_of<In, Real> x, quantity_of<Out, Real> y) {
    b.retune(next, x, y);
};
/// The frame of B's input moves while it runs.
template <class B, class In, class Real = real_of<B>>
concept shiftable = requires(B b, quantity_of<In, Real> by) {
    b.shift(by);
};

namespace detail {
/// Settles a block at x and returns what it then gives, without stepping it.
template <class Block, class X> auto settled(Block& block, const X& x) {
    block.settle(x);
    Block copy = block;
    return copy(x);
}
/// What the block would give, without stepping it.
template <class Block, class X> auto foreseen(Block block, const X& x) noexcept { return block(x); }
/// The parameters of another block of the same type, the state of this one; a block without parameters stays as
/// it is.
template <retunable Block> void retune(Block& block, const Block& next) noexcept {
    if constexpr (requires { block.retune(next); }) block.retune(next);
}
template <class Block>
concept responds = requires(const Block& block, frequency f) {
    block.response(f);
};
/// A user's box need not have a fault flag.
template <class Block> constexpr bool is_faulted(const Block& block) noexcept {
    if constexpr (requires { block.faulted(); })
        return block.faulted();
    else
        return false;
}
} // namespace detail

} // namespace quadrant::inline v0
