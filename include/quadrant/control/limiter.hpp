// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <cstddef>

namespace quadrant::inline v0 {

/// Clips a wire to what the amplifier can do.
///   y = low if x < low, high if x > high, else x
/// Source: docs/formats.md (limit of cascade_p_pi).
/// Ports: one scalar in, one scalar out, the same signal.
/// State: none; `reset` and `settle` set the held output and clear the fault. limited() = the last sample was
/// clipped. `retune(next)`: other bounds from the next step on, jump <= what they cut off or let through.
/// Range: low <= high; low of minus infinity and high of infinity are no bound. What comes out is finite,
/// always.
/// NaN and infinities: holds the last output, raises faulted() (an infinite input is a fault, not a large
/// demand). Throws "limiter.high = ...: must not lie below low (...)", "limiter.low = ...: must be a number",
/// "must leave a finite number above it" (a low bound of infinity), "limiter.high = ...: must leave a finite
/// number below it".
/// Cost: 2 comparisons. To bound the slope: `rate_limiter`.
template <signal_tag Signal, class Real = double> class limiter {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The range that passes, in the unit of the wire.
    struct parameters {
        quantity_of<Signal, number> low;  ///< may be minus infinity
        quantity_of<Signal, number> high; ///< >= low, may be infinite
    };
    struct state {};

    limiter(const parameters& p, duration period)
        : given_(p), low_(in_real<Real>(p.low)), high_(in_real<Real>(p.high)) {
        require_positive<Real>("limiter.period", period);
        for (std::size_t i = 0; i < lane_count<Real>; ++i) {
            const auto low_given = lane(p.low, i), high_given = lane(p.high, i);
            const double low = detail::plain(low_given), high = detail::plain(high_given);
            require(true, "limiter.low", low_given, "must be a number");
            require(low <= high, "limiter.high", high_given,
                    "must not lie below low (" + detail::shortest(low_given) + ")");
            // As the step uses them: 1e300 is infinite in float.
            const bool open_below = !detail::is_finite(detail::plain(lane(low_, i))),
                       open_above = !detail::is_finite(detail::plain(lane(high_, i)));
            require(!open_below || low < 0, "limiter.low", low_given, "must leave a finite number above it");
            require(!open_above || high > 0, "limiter.high", high_given, "must leave a finite number below it");
        }
    }

    value operator()(value x) noexcept {
        const auto good = finite(x);
        if (none(good)) return out_.hold();
        const value y = clipped(x);
        if constexpr (multi_lane<Real>)
            set_where(good, limited_, differs(y, x));
        else
            set_where(good, limited_, outside(x, low_, high_));
        return out_.keep(good, y);
    }
    void reset() noexcept {
        limited_ = mask_of<Real>();
        out_.reset();
    }
    void settle(value x) noexcept {
        const auto good = finite(x);
        set_where(good, limited_, outside(x, low_, high_));
        out_.settle(good, clipped(x));
    }
    void retune(const limiter& next) noexcept {
        low_ = next.low_;
        high_ = next.high_;
        given_ = next.given_;
    }

    bool limited() const noexcept { return any(limited_); } ///< some lane was
    mask_of<Real> limited_lanes() const noexcept { return limited_; }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    value clipped(value x) const noexcept { return limited_to(x, low_, high_); }

    parameters given_;
    value low_, high_;
    mask_of<Real> limited_{};
    held_output<value, false> out_;
};

} // namespace quadrant::inline v0
