// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>

namespace quadrant::inline v0 {

/// How far a tool is in the cut: 0 ... 1, moving at a constant rate towards where `engage` sends it, so that a
/// cutting force neither starts nor ends with a jump.
class tool_entry {
public:
    tool_entry() = default;
    /// entry: from outside to the full cut; 0: at once.
    tool_entry(const char* field, duration entry, duration period) {
        require_not_negative(field, entry);
        if (entry > period) rate_ = period / entry;
    }
    double depth() const noexcept { return depth_; }
    bool engaged() const noexcept { return engaged_; }
    void engage(bool in_the_cut) noexcept { engaged_ = in_the_cut; }
    void advance() noexcept {
        depth_ = engaged_ ? std::min(1.0, depth_ + rate_) : std::max(0.0, depth_ - rate_);
    }
    void settle(bool in_the_cut) noexcept {
        engaged_ = in_the_cut;
        depth_ = in_the_cut ? 1 : 0;
    }

private:
    double rate_ = 1, depth_ = 1;
    bool engaged_ = true;
};

} // namespace quadrant::inline v0
