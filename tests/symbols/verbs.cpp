// SPDX-License-Identifier: BSL-1.0
// Every verb of every block that a servo thread calls, as a function of its own on a block that was made
// elsewhere. check.sh compiles this file and looks at what it still asks the linker for: mathematics, and
// nothing that throws, allocates, waits or stops the program. With a compiler that knows
// [[clang::nonblocking]] it says so itself.
#include "conformance/blocks.hpp"

#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/loop/feed_control.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/loop/xy_control.hpp>
#include <quadrant/trajectory/stream_limiter.hpp>

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#if defined(__clang__) && __has_cpp_attribute(clang::nonblocking)
#    define QUADRANT_NONBLOCKING [[clang::nonblocking]]
#else
#    define QUADRANT_NONBLOCKING
#endif

namespace {
using namespace quadrant;
using conformance::values;

template <class Entry, class Real> using block_of = decltype(std::declval<const Entry&>()(values<Real>{}));

/// What a block is given and gives, kept where the compiler does not see it.
template <class Block, class Real> struct wires {
    quantity_of<typename Block::input, Real> in;
    decltype(std::declval<Block&>()(in)) out;
};
template <class Block, class Real> void step(Block& b, wires<Block, Real>& w) noexcept QUADRANT_NONBLOCKING {
    w.out = b(w.in);
}
template <class Block, class Real> void reset(Block& b, wires<Block, Real>&) noexcept QUADRANT_NONBLOCKING {
    b.reset();
#ifdef QUADRANT_ALLOCATES // what nonblocking.sh asks for, to see that it is noticed
    delete new Block(b);
#endif
}
template <class Block, class Real> void settle(Block& b, wires<Block, Real>& w) noexcept QUADRANT_NONBLOCKING {
    if constexpr (requires { b.settle(w.in); }) b.settle(w.in);
}
template <class Block, class Real>
void settle_both(Block& b, wires<Block, Real>& w) noexcept QUADRANT_NONBLOCKING {
    if constexpr (requires { b.settle(w.in, w.out); }) b.settle(w.in, w.out);
}
template <class Block, class Real> void applied(Block& b, wires<Block, Real>& w) noexcept QUADRANT_NONBLOCKING {
    if constexpr (requires { b.applied(w.out); }) b.applied(w.out);
}
template <class Block, class Real> void shift(Block& b, wires<Block, Real>& w) noexcept QUADRANT_NONBLOCKING {
    if constexpr (requires { b.shift(w.in); }) b.shift(w.in);
}
template <class Block, class Real> void ask(Block& b, wires<Block, Real>& w) noexcept QUADRANT_NONBLOCKING {
    if (b.faulted()) w.out = {};
    if constexpr (requires { b.limited(); })
        if (b.limited()) w.in = {};
}
template <class Block, class Real>
void retune(Block& b, const Block& next, wires<Block, Real>& w) noexcept QUADRANT_NONBLOCKING {
    if constexpr (requires { b.retune(next); })
        b.retune(next);
    else if constexpr (requires { b.retune(next, w.in, w.out); })
        b.retune(next, w.in, w.out);
    else if constexpr (retunable_law<Block>)
        b.retune(next, {}, {}, {}, w.out);
}
/// Their addresses: what has one is compiled.
template <class Function> const void* address(Function* f) { return reinterpret_cast<const void*>(f); }
template <class Block, class Real>
const std::array verbs_of{address(&step<Block, Real>),    address(&reset<Block, Real>),
                          address(&settle<Block, Real>),  address(&settle_both<Block, Real>),
                          address(&applied<Block, Real>), address(&shift<Block, Real>),
                          address(&ask<Block, Real>),     address(&retune<Block, Real>)};

/// Whole loops.
using boxes =
    milling_axis_boxes<maxwell_slip<4, signal::velocity, signal::voltage>,
                       disturbance_observer<signal::voltage>, repetitive<signal::position, 100, 2, 9, 7>>;
using control = xy_control<boxes, boxes>;
using single = cascade<
    cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, notch<signal::voltage>>>;
using feed = feed_control<feed_control_boxes<pid<>>>;
void xy_step(control& c, const control::motions& r, const control::positions& y,
             control::commands& u) noexcept QUADRANT_NONBLOCKING {
    u = c(r, y);
}
void xy_retune(control& c, const control& next, const control::motions& r) noexcept QUADRANT_NONBLOCKING {
    c.retune(next, r);
}
void xy_settle(control& c, const control::positions& y,
               const control::commands& u) noexcept QUADRANT_NONBLOCKING {
    c.settle(y, u);
}
void xy_track(control& c, const control::motions& r, const control::positions& y,
              const control::commands& u) noexcept QUADRANT_NONBLOCKING {
    c.track(r, r, y, u);
}
void single_step(single& c, quantity_of<signal::position> r, quantity_of<signal::position> y,
                 quantity_of<signal::voltage>& u) noexcept QUADRANT_NONBLOCKING {
    u = c(r, y);
}
void single_retune(single& c, const decltype(single::box)& next) noexcept QUADRANT_NONBLOCKING {
    c.retune(next);
}
void feed_step(feed& c, const axis_motion<>& r, const axis_measurement<>& y,
               quantity_of<signal::voltage>& u) noexcept QUADRANT_NONBLOCKING {
    u = c(r, y);
}
void feed_retune(feed& c, const decltype(feed::box)& next) noexcept QUADRANT_NONBLOCKING { c.retune(next); }

template <class Real, class... Entry>
const void* verb_in(const std::tuple<Entry...>*, std::size_t block, std::size_t verb) {
    const std::array all{verbs_of<block_of<Entry, Real>, Real>.data()...};
    return all[block][verb];
}
} // namespace

const void* verb_of_block(bool in_float, std::size_t block, std::size_t verb) {
    const decltype(&conformance::blocks) none = nullptr;
    return in_float ? verb_in<float>(none, block, verb) : verb_in<double>(none, block, verb);
}
const void* verb_of_loop(std::size_t verb) {
    const std::array all{address(&xy_step),   address(&xy_retune),   address(&xy_settle),
                         address(&xy_track),  address(&single_step), address(&single_retune),
                         address(&feed_step), address(&feed_retune)};
    return all[verb];
}
