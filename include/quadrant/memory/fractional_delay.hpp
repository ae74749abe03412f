// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/lanes/lane_by_lane.hpp"
#include "cubic_weights.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

namespace detail {
template <std::size_t Order, std::size_t Capacity>
concept delay_order = Order == 1 || (Order == 3 && Capacity >= 1);
} // namespace detail

/// Delays a wire by any time, not only whole periods: the dead time of a drive, 0.4 ms at 0.5 ms per sample.
///   y(t) = the polynomial through the Order + 1 samples around t - delay (Lagrange)
/// Source: [Laakso1996], Lagrange interpolation; Order 3 with the instant between its two middle samples, where
/// it is best.
/// Ports: one scalar in, one scalar out, the same signal.
/// State: the last Capacity + Order + 1 inputs, whatever the delay; `reset` leaves zeros and the delay of the
/// parameters, `settle(x)` fills it with x. `delay(d)` changes the delay between two steps.
/// At a change the output jumps by at most g |d' - d|/T times the largest step of the inputs that are read
/// between, and beside, both delays: g = 1 (Order 1), 4/3 (Order 3), the steepest slope of the cubic.
/// `retune(next)`: the delay that `next` has, with the same jump. `shift(by)`: the frame moves.
/// Range: Order 1 (straight line): 0 <= delay <= Capacity periods; Order 3 (cubic): one period <= delay <=
/// Capacity periods, because it needs a sample on either side. delay(d) outside saturates, and limited()
/// reports it.
/// Exact for polynomials up to Order, for any signal at whole periods; gain at 1/8 of the sampling rate and
/// half a period between
/// samples: 0.924 (Order 1), 0.992 (Order 3), never above one.
/// NaN and infinities: holds the last output, takes nothing in, raises faulted().
/// Throws "fractional_delay.delay = ...: must lie between ... and ... (capacity)".
/// Cost: 1 or 4 multiplications, 8 (Capacity + Order + 2) bytes of state. For whole periods: `delay_line`.
template <signal_tag Signal, std::size_t Capacity, std::size_t Order = 1, class Real = double>
requires detail::delay_order<Order, Capacity>
class fractional_delay {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The dead time, in seconds.
    struct parameters {
        quantity<si::time, number> delay; ///< (Order 1: 0, Order 3: 1) ... Capacity periods
    };
    /// The last inputs, enough for the longest delay.
    struct state {
        std::array<value, Capacity + Order + 1> x{}; ///< a ring
        std::size_t next = 0;                        ///< where the coming input goes
    };

    fractional_delay(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("fractional_delay.period", period);
        delay(p.delay);
        at_start_ = reads_;
        require(!limited_ && !out_.faulted(), "fractional_delay.delay", p.delay,
                "must lie between " + detail::shortest(least * period) + " and " +
                    detail::shortest(double(Capacity) * period) + " (capacity)");
    }

    value operator()(value x) noexcept {
        if (none(finite(x))) return out_.hold();
        const std::size_t now = state_.next;
        state_.x[now] = x;
        std::size_t at = now >= reads_.first ? now - reads_.first : now + size - reads_.first;
        value y{};
        for (std::size_t i = 0; i <= Order; ++i) {
            y += reads_.weight[i] * state_.x[at];
            at = at == 0 ? size - 1 : at - 1;
        }
        if (none(finite(y))) return out_.hold(); // the next sample takes the same place
        state_.next = now + 1 == size ? 0 : now + 1;
        return out_.keep(y);
    }
    void reset() noexcept {
        reads_ = at_start_; // not made again, which under -ffast-math need not give the same bits
        limited_ = false;
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

    void retune(const fractional_delay& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        reads_ = next.reads_;
        at_start_ = next.at_start_;
        limited_ = next.limited_;
        given_ = next.given_;
    }
    void delay(quantity<si::time, number> d) noexcept {
        if (none(finite(d))) return out_.raise();
        number periods = d.value() / number(period_.value());
        const double plain = detail::plain(periods);
        limited_ = plain < least || plain > double(Capacity);
        if (limited_) periods = plain < least ? number(least) : number(double(Capacity));
        const double whole = std::floor(detail::plain(periods));
        reads_.first = std::size_t(whole - least);
        const number u = periods - number(whole); // 0 ... 1 between the two samples around the instant
        if constexpr (Order == 1)
            reads_.weight = {Real(1 - u), Real(u)};
        else {
            const auto cubic = detail::cubic_weights(u);
            for (std::size_t i = 0; i <= Order; ++i) reads_.weight[i] = Real(cubic[i]);
        }
    }

    std::complex<double> response(frequency f) const {
        const double angle = -2 * std::numbers::pi * f.value() * period_.value();
        std::complex<double> sum = 0;
        for (std::size_t i = 0; i <= Order; ++i)
            sum += detail::plain(reads_.weight[i]) * std::polar(1.0, angle * double(reads_.first + i));
        return sum;
    }
    bool limited() const noexcept { return limited_; } ///< the last delay(d) lay outside the range
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static constexpr double least = Order == 3 ? 1 : 0;
    static constexpr std::size_t size = Capacity + Order + 1;

    struct polynomial {
        std::array<Real, Order + 1> weight{};
        std::size_t first = 0; ///< age of the youngest sample
    };

    parameters given_;
    duration period_;
    polynomial reads_, at_start_; ///< of the delay in use; of that of the parameters
    bool limited_ = false;
    state state_;
    held_output<value> out_;
};

/// In lanes: each lane has its own delay, and the call loops over the lanes.
template <signal_tag Signal, std::size_t Capacity, std::size_t Order, several_lanes Real>
requires detail::delay_order<Order, Capacity>
class fractional_delay<Signal, Capacity, Order, Real>
    : public lane_by_lane<fractional_delay<Signal, Capacity, Order, typename Real::single>, Real> {
    using one = fractional_delay<Signal, Capacity, Order, typename Real::single>;

public:
    /// The dead time of each lane, in seconds.
    struct parameters {
        quantity<si::time, Real> delay; ///< (Order 1: 0, Order 3: 1) ... Capacity periods
    };
    fractional_delay(const parameters& p, duration period)
        : lane_by_lane<one, Real>(
              [&](std::size_t i) {
                  return typename one::parameters{in_real<typename Real::single>(lane(p.delay, i))};
              },
              period),
          given_(p) {}
    void retune(const fractional_delay& next) noexcept {
        this->retune_each(next);
        given_ = next.given_;
    }
    void delay(quantity<si::time, Real> d) noexcept {
        for (std::size_t i = 0; i < lane_count<Real>; ++i)
            this->of(i).delay(in_real<typename Real::single>(lane(d, i)));
    }
    const parameters& given() const noexcept { return given_; }

private:
    parameters given_;
};

} // namespace quadrant::inline v0
