// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "cubic_weights.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0 {

namespace detail {
template <std::size_t Capacity>
concept holds_a_cycle = Capacity >= 8;
} // namespace detail

/// Follows how long a cycle of what repeats on a wire lasts, so that a `repetitive` memory stays in step with a
/// spindle whose speed changes: memory.cycle(tracker.cycle()).
///   e[k] = x[k] - x(k - d),  s[k] = (x(k - d + 1) - x(k - d - 1))/2   between samples by cubic interpolation
///   P[k] = (1 - T/settles_in) P[k-1] + s^2,  d[k+1] = d[k] - s e/P    in periods T
/// To first order e = s (d - true cycle): the rule is least squares with forgetting. All harmonics count, each
/// by its power, and noise on the wire moves d but does not bias it.
/// Source: [Etter1981], an adaptive delay whose gradient is the difference of its neighbours; [Ljung1999] least
/// squares with forgetting.
/// Ports: the wire in; out e, what does not repeat on it. The cycle: cycle(). Feed it a wire on which the cycle
/// stays when the memory works, such as the estimate of a `disturbance_observer`; the error goes to zero.
/// State: the last Capacity + 4 inputs, d, P. `reset`: as new, with the cycle of the parameters; `settle(x)`: a
/// wire that stands at x, with the cycle as it is.
/// Range: the true cycle within `range` of the one given, and nearer than half the period of the fastest strong
/// harmonic, or d ends in a neighbouring valley. d is held within the range (limited() reports it), until a
/// whole cycle has been seen, and while the rms of s is not above `least`.
/// NaN and infinities: holds the last output, takes nothing in, raises faulted().
/// Throws "cycle_tracker.<field> = ...: must ..." for cycle, range, settles_in, least and the period.
/// Cost: 14 multiplications, 1 division, 8 (Capacity + 6) bytes.
template <signal_tag Signal, std::size_t Capacity, class Real = double>
requires detail::holds_a_cycle<Capacity>
class cycle_tracker {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// Where to look for the cycle, and how fast.
    struct parameters {
        quantity<si::time, number> cycle; ///< at first; with the range 3 ... Capacity periods
        number range = number(0.05);      ///< of the cycle, to either side; 0 < range < 0.5
        duration settles_in;              ///< time constant of the approach; at least one cycle
        value least{};                    ///< rms change from sample to sample that shows a cycle; >= 0
    };
    /// The last inputs, the cycle and the power of their slope.
    struct state {
        std::array<value, Capacity + 4> x{}; ///< a ring
        std::size_t next = 0;                ///< where the coming input goes
        std::size_t seen = 0;                ///< inputs, up to a whole cycle
        Real periods{};                      ///< d
        Real power{};                        ///< P, of the bare number
    };

    cycle_tracker(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("cycle_tracker.period", period);
        require(detail::plain(p.range) > 0 && detail::plain(p.range) < 0.5, "cycle_tracker.range", p.range,
                "must lie between 0 and 0.5");
        const number periods = p.cycle.value() / number(period.value());
        lowest_ = Real(periods * (number(1) - p.range)), highest_ = Real(periods * (number(1) + p.range));
        require(detail::plain(lowest_) >= 3 && detail::plain(highest_) <= double(Capacity),
                "cycle_tracker.cycle", p.cycle,
                "must lie, with its range, between " + detail::shortest(3.0 * period) + " and " +
                    detail::shortest(double(Capacity) * period) + " (capacity)");
        require(p.settles_in.value() >= detail::plain(p.cycle), "cycle_tracker.settles_in", p.settles_in,
                "must be at least one cycle");
        require_not_negative<Real>("cycle_tracker.least", p.least);
        forgets_ = period.value() / p.settles_in.value();
        reset();
    }

    value operator()(argument x) noexcept {
        if (!finite(x)) return out_.hold();
        const auto whole = static_cast<std::size_t>(detail::plain(state_.periods));
        const auto weights = detail::cubic_weights(Real(state_.periods - Real(double(whole))));
        state_.x[state_.next] = x;
        std::array<value, 6> around; // whole - 2 ... whole + 3 samples ago
        for (std::size_t i = 0; i < around.size(); ++i) around[i] = ago(whole - 2 + i);
        value off{}, slope{}; // of differences: a wire that stands gives zero exactly
        for (std::size_t i = 0; i < 4; ++i) {
            off += weights[i] * (x - around[1 + i]);
            slope += Real(0.5) * weights[i] * (around[i] - around[2 + i]);
        }
        if (!finite(off, slope)) return out_.hold(); // the next sample takes the same place
        state_.next = state_.next + 1 == size ? 0 : state_.next + 1;
        if (state_.seen < whole + 4)
            ++state_.seen;
        else
            approach(Real(off.value()), Real(slope.value()));
        return out_.keep(off);
    }
    void reset() noexcept {
        state_ = {};
        state_.periods = Real(given_.cycle.value() / number(period_.value()));
        limited_ = false;
        out_.reset();
    }
    void settle(argument x) noexcept {
        if (!finite(x)) return out_.raise();
        state_.x.fill(x);
        state_.next = state_.seen = 0;
        state_.power = Real(0);
        out_.reset();
    }

    quantity<si::time, Real> cycle() const noexcept {
        return state_.periods * quantity<si::time, Real>::from_value(Real(period_.value()));
    }
    bool limited() const noexcept { return limited_; } ///< the last step was held within the range
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static constexpr std::size_t size = Capacity + 4;

    value ago(std::size_t samples) const noexcept {
        return state_.x[state_.next >= samples ? state_.next - samples : state_.next + size - samples];
    }
    void approach(const Real& off, const Real& slope) noexcept {
        const Real power = Real(1 - forgets_) * state_.power + slope * slope;
        state_.power = unless_died_out(power);
        const double least = detail::plain(given_.least.value());
        if (!(detail::plain(power) * forgets_ > least * least)) return;
        Real next = state_.periods - slope * off / power;
        limited_ = !(next >= lowest_ && next <= highest_);
        if (next < lowest_) next = lowest_;
        if (next > highest_) next = highest_;
        state_.periods = next;
    }

    parameters given_;
    duration period_;
    Real lowest_{}, highest_{};
    double forgets_ = 0; ///< share of P that a sample loses
    bool limited_ = false;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
