// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/select.hpp"

namespace quadrant::inline v0 {

/// Play between what drives and what is driven: after a reversal the driven side stands still until the play is
/// crossed.
///   y[k] = x[k] - width/2 if that is above y[k-1],  x[k] + width/2 if that is below y[k-1],  else y[k-1]
/// Source: [Yeung2006] eq. (17), whose dead zone [d-, d+] is [y - width/2, y + width/2]: the play operator.
/// Ports: driving position in, driven position out. The driven side is taken to be held by its own friction: it
/// neither swings on nor falls back inside the play, and its weight does not choose a flank.
/// State: y; `reset` at zero, in the middle of the play; `settle(x)` at x, in the middle of the play.
/// Range: width >= 0; 0: y = x.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "backlash.width = ...: must be finite and not below 0".
/// Cost: 2 additions, 2 comparisons. What a command adds against it: `backlash_compensation`.
template <signal_tag Signal = signal::position, class Real = double> class backlash {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// How far the drive can move without the load.
    struct parameters {
        quantity_of<Signal, number> width{}; ///< from flank to flank; >= 0
    };
    /// Where the load stands.
    struct state {
        value y{};
    };

    backlash(const parameters& p, duration period) : given_(p), half_(in_real<Real>(p.width) * Real(0.5)) {
        require_positive<Real>("backlash.period", period);
        require_not_negative<Real>("backlash.width", p.width);
    }

    value operator()(argument x) noexcept {
        const value y = limited_to(state_.y, x - half_, x + half_);
        if (!finite(x, y)) return out_.hold();
        state_.y = y;
        return out_.keep(y);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument x) noexcept {
        if (!finite(x)) return out_.raise();
        state_.y = x;
        out_.reset(x);
    }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    value half_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
