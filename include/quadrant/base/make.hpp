// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "error.hpp"

#include <optional>
#include <type_traits>

/// Blocks without exceptions: what a constructor refuses comes back as a value.
///   auto resonance = make<notch<signal::force>>({.centre = 330_Hz, .width = 0.4}, 500_us);
///   if (!resonance) resonance.why().write(text, sizeof text);   // else *resonance, resonance->
/// The rules are those of the constructor, with and without -fno-exceptions.
namespace quadrant::inline v0 {

namespace detail {
template <class Block> struct parameters_of {
    using type = typename Block::parameters;
    static Block build(const type& p, duration period) { return Block(p, period); }
};
template <class Loop> // a loop around a member `box`, as `cascade`
requires requires(Loop& l) { typename decltype(l.box)::parameters; }
struct parameters_of<Loop> {
    using type = typename decltype(Loop::box)::parameters;
    static Loop build(const type& p, duration period) { return Loop{.box = {p, period}}; }
};
/// Converts to the block in the place where the block is to be: no copy.
template <class Block> struct in_place {
    const typename parameters_of<Block>::type& given;
    duration period;
    operator Block() const { return parameters_of<Block>::build(given, period); }
};
} // namespace detail

/// A block, or why there is none. Constant-initialised when empty: in static storage it needs neither a guard
/// nor the heap.
template <class Block> class made {
public:
    using parameters = typename detail::parameters_of<Block>::type;
    static_assert(std::is_trivially_destructible_v<Block>, "a block holds nothing that has to be released");

    /// A new block in place of the old one; false: there is none now, and why() says why.
    bool make(const parameters& p, duration period) {
        block_.reset();
#ifdef __cpp_exceptions
        try {
            build(p, period);
        } catch (const invalid_parameter& refused) {
            if (!refused.why) throw;
            why_ = *refused.why;
        }
#else
        detail::attempt here{{}, why_};
        detail::attempt* const outer = detail::attempt::running;
        detail::attempt::running = &here;
        if (setjmp(here.back) == 0)
            build(p, period);
        else
            why_ = here.why;
        detail::attempt::running = outer;
#endif
        return block_.has_value();
    }

    explicit operator bool() const noexcept { return block_.has_value(); }
    Block& operator*() noexcept { return *block_; } ///< only when there is one
    const Block& operator*() const noexcept { return *block_; }
    Block* operator->() noexcept { return &*block_; }
    const Block* operator->() const noexcept { return &*block_; }
    const refused_parameter& why() const noexcept { return why_; } ///< of the last one that was refused

private:
    // Not inlined into the frame that setjmp returns to: no register of it is in doubt.
    [[gnu::noinline]] void build(const parameters& p, duration period) {
        block_.emplace(detail::in_place<Block>{p, period});
    }

    std::optional<Block> block_;
    refused_parameter why_{};
};

/// Makes a block from parameters that may be refused, without an exception: ask the answer whether it holds
/// one.
template <class Block> made<Block> make(const typename detail::parameters_of<Block>::type& p, duration period) {
    made<Block> out;
    out.make(p, period);
    return out;
}

} // namespace quadrant::inline v0
