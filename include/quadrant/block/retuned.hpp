// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <tuple>

namespace quadrant::inline v0::detail {

/// `retune` of a block whose parameters change and whose memory stays: all of `next` but `out`, the last good
/// output, and `kept`, the states. A block of another period does not fit: that raises the fault.
template <class Block, class Held, class... Kept>
void retuned(Block& block, const Block& next, bool fits, Held& out, Kept&... kept) noexcept {
    if (!fits) return out.raise();
    const std::tuple<Held, Kept...> before(out, kept...);
    block = next;
    std::tie(out, kept...) = before;
}

} // namespace quadrant::inline v0::detail
