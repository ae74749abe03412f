// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/lanes/lane_by_lane.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// Gives a wire back a whole number of periods later: lines up a reference with a late measurement, or models a
/// dead time.
///   y[k] = x[k - length]
/// Ports: one scalar in, one scalar out, the same signal.
/// State: the last Capacity + 1 inputs, whatever the length; `reset` leaves zeros and the length of the
/// parameters, `settle(x)` fills it with x. `length(n)` changes the length between two steps: a longer delay
/// reads inputs that were really there (zeros before the first), a shorter one skips some; nothing is ever read
/// that was not put in. At a change the output jumps by x[k-n'] - x[k-n]: at most |n' - n| times the largest
/// step of those inputs. `retune(next)`: the length that `next` has, with the same jump.
/// `shift(by)`: the frame moves.
/// Range: 0 <= length <= Capacity; length(n) above saturates, and limited() reports it. Length 0 is a piece of
/// wire.
/// NaN and infinities: holds the last output, takes nothing in (the line stands still), raises faulted().
/// Throws "delay_line.length = ...: must not exceed the capacity (...)".
/// Cost: no arithmetic, 8 (Capacity + 2) bytes of state. For a delay that is no whole number of periods:
/// `fractional_delay`.
template <signal_tag Signal, std::size_t Capacity, class Real = double> class delay_line {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// How late the output is.
    struct parameters {
        std::size_t length; ///< in periods; 0 ... Capacity
    };
    /// The last inputs, enough for the longest delay.
    struct state {
        std::array<value, Capacity + 1> x{}; ///< a ring
        std::size_t next = 0;                ///< where the coming input goes
    };

    delay_line(const parameters& p, duration period) : given_(p), period_(period), length_(p.length) {
        require_positive<Real>("delay_line.period", period);
        require(p.length <= Capacity, "delay_line.length", double(p.length),
                "must not exceed the capacity (" + detail::shortest(double(Capacity)) + ")");
    }

    value operator()(value x) noexcept {
        if (none(finite(x))) return out_.hold();
        const std::size_t now = state_.next;
        state_.x[now] = x;
        state_.next = now == Capacity ? 0 : now + 1;
        return out_.keep(state_.x[now >= length_ ? now - length_ : now + (Capacity + 1) - length_]);
    }
    void reset() noexcept {
        length(given_.length);
        settle(value());
    }
    void settle(value x) noexcept {
        if (none(finite(x))) return out_.raise();
        state_.x.fill(x);
        state_.next = 0;
        out_.reset(x);
    }

    void shift(value by) noexcept {
        if (none(finite(by))) return out_.raise();
        for (value& each : state_.x) each += by;
        out_.keep(out_.last() + by);
    }

    void retune(const delay_line& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        length_ = next.length_;
        limited_ = next.limited_;
        given_ = next.given_;
    }
    void length(std::size_t periods) noexcept {
        limited_ = periods > Capacity;
        length_ = limited_ ? Capacity : periods;
    }
    std::size_t length() const noexcept { return length_; }

    std::complex<double> response(frequency f) const {
        return std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value() * double(length_));
    }
    bool limited() const noexcept { return limited_; } ///< the last length(n) asked for more than Capacity
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    duration period_;
    std::size_t length_;
    bool limited_ = false;
    state state_;
    held_output<value> out_;
};

/// In lanes: each lane has its own length, and the call loops over the lanes.
template <signal_tag Signal, std::size_t Capacity, several_lanes Real>
class delay_line<Signal, Capacity, Real>
    : public lane_by_lane<delay_line<Signal, Capacity, typename Real::single>, Real> {
    using one = delay_line<Signal, Capacity, typename Real::single>;

public:
    /// How late the output of each lane is.
    struct parameters {
        std::array<std::size_t, lane_count<Real>> length; ///< in periods; 0 ... Capacity
    };
    delay_line(const parameters& p, duration period)
        : lane_by_lane<one, Real>([&](std::size_t i) { return typename one::parameters{p.length[i]}; }, period),
          given_(p) {}
    void retune(const delay_line& next) noexcept {
        this->retune_each(next);
        given_ = next.given_;
    }
    const parameters& given() const noexcept { return given_; }

private:
    parameters given_;
};

} // namespace quadrant::inline v0
