// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <cstddef>

namespace quadrant::inline v0 {

/// Bounds how fast a wire may change: a demand that must not jump.
///   y[k] = x[k], but at most rate T away from y[k-1]
/// Source: LinuxCNC limit2 (its maxv).
/// Ports: one scalar in, one scalar out, the same signal.
/// State: the last output; `reset` leaves 0, `settle(x)` stands at x. limited() = the last sample could not
/// follow. `retune(next)`: another rate from the next step on, jump <= |rate' - rate| T.
/// Range: rate > 0, the same up and down; infinite = no bound.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "rate_limiter.rate = ...: must be above 0".
/// Cost: 2 additions, 2 comparisons, 8 bytes of state. To bound the value: `limiter`.
template <signal_tag Signal, class Real = double> class rate_limiter {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The steepest slope, in units of the wire per second.
    struct parameters {
        quantity<unit_quotient<typename Signal::unit, si::time>, number> rate; ///< > 0, may be infinite
    };
    /// Where the output is: the next one is at most rate times period from here.
    struct state {
        value y{}; ///< last output
    };

    rate_limiter(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("rate_limiter.period", period);
        require_lanes([&](std::size_t i) { return detail::plain(lane(p.rate, i)) > 0; }, "rate_limiter.rate",
                      p.rate, "must be above 0 (infinite: no bound)");
        most_ = value::from_value(Real(p.rate.value() * number(period.value())));
    }

    value operator()(value x) noexcept {
        const value low = state_.y - most_, high = state_.y + most_;
        const value y = limited_to(x, low, high);
        const auto good = finite(x, y);
        if (none(good)) return out_.hold();
        set_where(good, limited_, outside(x, low, high));
        set_where(good, state_.y, y);
        return out_.keep(good, y);
    }
    void reset() noexcept { settle(value()); }
    void settle(value x) noexcept {
        const auto good = finite(x);
        set_where(good, state_.y, x);
        set_where(good, limited_, mask_of<Real>());
        out_.settle(good, x);
    }

    void retune(const rate_limiter& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        most_ = next.most_;
        given_ = next.given_;
    }

    bool limited() const noexcept { return any(limited_); } ///< some lane was
    mask_of<Real> limited_lanes() const noexcept { return limited_; }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    duration period_;
    value most_;
    state state_;
    mask_of<Real> limited_{};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
