// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../block/retuned.hpp"

namespace quadrant::inline v0 {

/// Crosses the play of a screw or gear when the reference reverses, without a jolt: what has to be added to the
/// reference of a motor whose encoder sits before the play, so that the load goes where it was asked.
///   y -> side play / 2 at no more than `rate`; side = +1, -1: the way the reference goes. It reverses once the
///   reference has come back by more than `hysteresis` from where it turned.
/// Source: LinuxCNC motion, BACKLASH with a rate of its own; the side is that of a play operator as wide as the
/// hysteresis.
/// Ports: reference position in; position to be added out. For the feedforward of velocity: rate() is what y
/// moves at.
/// State: side, turning point, y. `reset`: at zero, side unknown, y = 0, so the first move takes half the play
/// only. `settle(x)` the same at x; `settle(x, side)` with the flanks in touch, y = side play / 2: after homing
/// from that side.
/// `retune(next)`: another play, rate or hysteresis; y goes on from where it is: no step above rate' times
/// period.
/// Range: play >= 0, rate > 0, hysteresis >= 0 and above the encoder's count, where the reference is a measured
/// one. No step of the output is above rate times period. Crossing takes play / rate; meanwhile the load stands
/// still.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "backlash_compensation.<field> = ...: must ..." for play, rate, hysteresis and the period.
/// Cost: 2 additions, 4 comparisons, 24 bytes. Corners rounded as well: a `lowpass` behind it (not wider than
/// play / rate). An encoder on the load needs none of this, nor does a direct drive.
template <signal_tag Signal = signal::position, class Real = double> class backlash_compensation {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using speed = quantity<unit_quotient<typename Signal::unit, si::time>, Real>;

    /// The play to cross, how fast to cross it, and what counts as a reversal.
    struct parameters {
        quantity_of<Signal, number> play{}; ///< whole width, flank to flank; >= 0
        quantity<unit_quotient<typename Signal::unit, si::time>, number> rate{}; ///< of y; > 0
        quantity_of<Signal, number> hysteresis{};                                ///< of the reference; >= 0
    };
    /// Which way the reference goes, where it would turn, and how much of the play is added.
    struct state {
        argument turn{}; ///< furthest the reference went to `side`; where it started for side 0
        value y{};
        int side = 0; ///< +1, -1; 0: not known yet
    };

    backlash_compensation(const parameters& p, duration period)
        : given_(p), half_(in_real<Real>(quantity_of<Signal, number>(p.play * number(0.5)))),
          hysteresis_(in_real<Real>(p.hysteresis)), period_(period) {
        require_positive<Real>("backlash_compensation.period", period);
        require_not_negative<Real>("backlash_compensation.play", p.play);
        require_positive<Real>("backlash_compensation.rate", p.rate);
        require_not_negative<Real>("backlash_compensation.hysteresis", p.hysteresis);
        most_ = value::from_value(Real(p.rate.value() * number(period.value())));
    }

    value operator()(argument x) noexcept {
        state next = followed(x);
        const value goal = target(next.side), low = state_.y - most_, high = state_.y + most_;
        next.y = goal > high ? high : goal < low ? low : goal;
        if (!finite(x, next.turn, next.y)) return out_.hold();
        moved_ = next.y - state_.y;
        state_ = next;
        return out_.keep(next.y);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument x) noexcept { settle(x, 0); }
    void settle(argument x, int side) noexcept {
        if (!finite(x)) return out_.raise();
        side = side > 0 ? 1 : side < 0 ? -1 : 0;
        state_ = {x, target(side), side};
        moved_ = value();
        out_.reset(state_.y);
    }

    void retune(const backlash_compensation& next) noexcept {
        detail::retuned(*this, next, next.period_ == period_, out_, state_, moved_);
    }

    bool crossing() const noexcept {
        return state_.y != target(state_.side);
    } ///< the load is not yet taken along
    speed rate() const noexcept { return speed::from_value(moved_.value() / Real(period_.value())); }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    state followed(argument x) const noexcept {
        state next = state_;
        if (x > state_.turn + (state_.side > 0 ? argument() : hysteresis_))
            next.turn = x, next.side = 1;
        else if (x < state_.turn - (state_.side < 0 ? argument() : hysteresis_))
            next.turn = x, next.side = -1;
        return next;
    }
    value target(int side) const noexcept { return side > 0 ? half_ : side < 0 ? -half_ : value(); }

    parameters given_;
    value half_;
    argument hysteresis_;
    duration period_;
    value most_;
    state state_;
    value moved_{};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
