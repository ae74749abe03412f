// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../block/retuned.hpp"

#include <cstdint>

namespace quadrant::inline v0 {

/// Velocity from a coarse encoder, by the time between its edges: where a count takes many samples, a
/// difference reads zero, a whole count in one sample, and zero again.
///   v = (edge - reference) / (time between both)   at an edge that comes `window` or more after the reference
///   |v| <= step / (time since the last edge)       between edges: no faster than the edge that did not come
/// The edge lies half a step before the reading, seen in the direction of motion. It becomes the reference of
/// the next measurement. At a reversal the axis crosses the same edge twice: v = 0 and the edge is the
/// reference.
/// Source: [Ohmae1982] (counts over the time between edges, the M/T method).
/// Ports: reading of the encoder in, its rate out; second argument the age of the last edge at this sample,
/// where the encoder's input has a capture timer (0 ... the period; 0: an edge counts as of the sample that
/// first sees it).
/// State: last reading, reference edge, and how long ago both edges were. `reset`: at rest at zero;
/// `settle(x)`: at rest at x; `settle(x, v)`: has been moving at v, x was its last sample.
/// `retune(next)`: another step, window or rest from the next edge on; jump: none between edges but the new
/// bound.
/// Range: step > 0, window >= the period, rest >= window: after so long without an edge v is zero, so nothing
/// slower than step / rest is seen. At a constant speed the error is at most |v| T / window (without a capture
/// timer); a change of speed is seen late by half the time between edges, at least half the window.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "edge_velocity.<field> = ...: must ..." for period, step, window, rest.
/// Cost: 1 division a sample, 48 bytes of state. Many counts a sample: `filtered_derivative`; with a model of
/// the axis: `kalman`.
template <signal_tag In, rate_of<In> Out, class Real = double> class edge_velocity {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using time = quantity<si::time, Real>;

    /// The encoder's count, over how long a speed is measured, and when an axis is at rest.
    struct parameters {
        quantity_of<In, number> step{}; ///< one count; > 0
        duration window{};              ///< at least so long between the edges of a measurement; >= the period
        duration rest{};                ///< without an edge for so long: at rest; >= window
    };
    /// The last reading, the edge that a measurement starts from, and what was measured.
    struct state {
        argument reading{}, reference{};
        value v{};           ///< of the last measurement
        Real part{}, late{}; ///< ages of the reference and of the last edge at their samples, in periods
        std::uint32_t since_reference = 0; ///< samples
        std::uint32_t since_edge = 0;
        int side = 0; ///< +1, -1: direction of the last edge; 0: there is no edge to measure from
    };

    edge_velocity(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("edge_velocity.period", period);
        require_positive<Real>("edge_velocity.step", p.step);
        require(detail::is_finite(p.window.value()) && p.window >= period, "edge_velocity.window", p.window,
                "must be finite and not below the period (" + detail::shortest(period) + ")");
        require(p.rest >= p.window && p.rest / period < most_samples, "edge_velocity.rest", p.rest,
                "must not be below window (" + detail::shortest(p.window) + ") and below 1e9 periods");
        step_ = in_real<Real>(p.step);
        half_ = in_real<Real>(quantity_of<In, number>(p.step * number(0.5)));
        window_ = p.window / period * (1 - 1e-9); // a multiple of the period is met by as many samples
        rest_ = p.rest / period;
        per_period_ = quantity<si::frequency, Real>::from_value(Real(1 / period.value()));
    }

    value operator()(argument x, time age = time()) noexcept {
        // First: behind the comparisons a compiler may take x for the last reading (-ffast-math).
        if (!finite(x, age)) return out_.hold();
        state next = state_;
        if (next.since_edge < most_samples) ++next.since_reference, ++next.since_edge;
        const Real late = limited_to(Real(age * per_period_), Real(0), Real(1));
        if (x > next.reading || x < next.reading)
            met(next, x, late);
        else if (double(next.since_edge) > rest_)
            next.v = value(), next.side = 0;
        next.reading = x;
        const value v = limited(next);
        if (!finite(v, next.reference, next.v)) return out_.hold();
        state_ = next;
        return out_.keep(v);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument x) noexcept { settle(x, value()); }
    void settle(argument x, value rate) noexcept {
        if (!finite(x, rate)) return out_.raise();
        state_ = {};
        state_.reading = x;
        state_.v = rate;
        state_.side = rate > value() ? 1 : rate < value() ? -1 : 0;
        state_.reference = edge(x, state_.side);
        out_.reset(rate);
    }
    void shift(argument by) noexcept {
        if (!finite(by)) return out_.raise();
        state_.reading += by;
        state_.reference += by;
    }
    void retune(const edge_velocity& next) noexcept {
        detail::retuned(*this, next, next.period_ == period_, out_, state_);
    }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static constexpr std::uint32_t most_samples = 1'000'000'000;

    /// Where the edge lies that was crossed to come to x.
    argument edge(argument x, int side) const noexcept {
        return side > 0 ? x - half_ : side < 0 ? x + half_ : x;
    }
    /// An edge: a speed where the window is full, zero at a reversal, a first reference where there was none.
    void met(state& next, argument x, const Real& late) const noexcept {
        const int side = x > next.reading ? 1 : -1;
        const argument at = edge(x, side);
        const Real periods = Real(double(next.since_reference)) + next.part - late;
        const bool measured = side == next.side, full = periods >= Real(window_);
        if (measured && full)
            next.v = per_period_ * ((at - next.reference) / periods);
        else if (!measured)
            next.v = value();
        if (full || !measured) next.reference = at, next.since_reference = 0, next.part = late;
        next.since_edge = 0;
        next.late = late;
        next.side = side;
    }
    value limited(const state& s) const noexcept {
        if (s.since_edge == 0) return s.v;
        return limited_to(s.v, value(per_period_ * (step_ / (Real(double(s.since_edge)) + s.late))));
    }

    parameters given_;
    duration period_;
    argument step_, half_;
    double window_ = 1, rest_ = 1; ///< in periods
    quantity<si::frequency, Real> per_period_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
