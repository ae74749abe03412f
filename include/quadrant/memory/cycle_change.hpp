// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/select.hpp"

#include <cmath>
#include <cstddef>

namespace quadrant::detail {

/// What repeats in a repetitive memory, in periods, and how another cycle takes over: at once when none is on
/// its way, else when that fade is done. The one place of this; `repetitive` asks it, alone and in lanes.
/// `Number`: of parameters, several lanes too; their fade is common, as long as the longest needs. How many
/// steps of it are left belongs to the state of the memory: `fading`.
template <class Number> class cycle_change {
    static constexpr double rounding = 1e-12; ///< of a cycle that was given as a multiple of the period

public:
    /// The memory as new: this cycle, nothing on its way.
    void begin(const Number& cycle) noexcept {
        pending_ = limited_ = false;
        periods_ = cycle;
    }
    /// Another cycle is wanted, within what the memory holds. True when it starts now: then start(...).
    bool ask(const Number& cycle, double low, double high, bool fading) noexcept {
        limited_ = any(less(plain_of(cycle), low * (1 - rounding))) ||
                   any(less(high * (1 + rounding), plain_of(cycle)));
        wanted_ = limited_to(cycle, Number(low), Number(high));
        pending_ = fading;
        return !pending_;
    }
    bool is_pending() const noexcept { return pending_; }
    /// The wanted cycle is the cycle from now on. The steps of its fade, 0 where nothing changes.
    std::size_t start(double fade, double period) noexcept {
        pending_ = false;
        if (all(equal(plain_of(wanted_), plain_of(periods_)))) return 0;
        periods_ = wanted_;
        steps_ = std::size_t(std::ceil(fade > 0 ? fade / period : longest(periods_)));
        return steps_;
    }
    /// Share of the old cycle with so many steps left.
    double left(std::size_t fading) const noexcept { return double(fading) / double(steps_); }
    const Number& periods() const noexcept { return periods_; }
    bool limited() const noexcept { return limited_; } ///< the last one that was asked for lay outside

    /// Is a cycle of so many periods within the range, but for the rounding of a multiple of the period?
    static bool fits(double cycle, double low, double high) noexcept {
        return cycle >= low * (1 - rounding) && cycle <= high * (1 + rounding);
    }

private:
    static decltype(auto) plain_of(const Number& n) noexcept {
        if constexpr (several_lanes<Number>)
            return (n);
        else
            return plain(n);
    }
    static double longest(const Number& n) noexcept {
        double out = plain(lane(n, 0));
        for (std::size_t i = 1; i < lane_count<Number>; ++i)
            if (plain(lane(n, i)) > out) out = plain(lane(n, i));
        return out;
    }

    Number periods_{0}, wanted_{0};
    std::size_t steps_ = 1;
    bool pending_ = false, limited_ = false;
};

} // namespace quadrant::detail
