// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <complex>
#include <numbers>

namespace quadrant::inline v0 {

/// Velocity from an encoder: backward difference of the mean of the last two samples.
///   m[k] = (y[k] + y[k-1]) / 2,   v[k] = (m[k] - m[k-1]) / T = (y[k] - y[k-2]) / (2 T)
/// Source: docs/formats.md (velocity_estimator two_sample_mean).
/// Ports: one scalar in, its rate out; sign kept.
/// State: the last two inputs; `reset` leaves 0, so a first sample reads as a jump: `settle(y0)` first.
/// `settle(y)` stands still at y; `settle(y, rate)` has been moving at that rate and y was its last sample.
/// `shift(by)`: the frame moves.
/// Range: late by one period exactly, at all frequencies; zero gain at half the sampling rate.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "two_sample_derivative.period = ...: must be finite and above 0".
/// Cost: 1 multiplication, 16 bytes of state. With a corner to choose: `filtered_derivative`.
template <signal_tag In, rate_of<In> Out, class Real = double> class two_sample_derivative {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    struct parameters {};
    /// The last two positions.
    struct state {
        argument y1{}, y2{}; ///< last input and the one before
    };

    two_sample_derivative(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("two_sample_derivative.period", period);
        half_rate_ = quantity<si::frequency, Real>::from_value(Real(0.5 / period.value()));
    }

    value operator()(argument y) noexcept {
        const value v = half_rate_ * (y - state_.y2);
        const auto good = finite(v);
        if (none(good)) return out_.hold();
        set_where(good, state_.y2, state_.y1);
        set_where(good, state_.y1, y);
        return out_.keep(good, v);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument y) noexcept { settle(y, value()); }
    void settle(argument y, value rate) noexcept {
        const argument before = y - rate * in_real<Real>(period_);
        const auto good = finite(before, rate);
        set_where(good, state_.y1, y);
        set_where(good, state_.y2, before);
        out_.settle(good, rate);
    }
    void shift(argument by) noexcept {
        const auto good = finite(by);
        set_where(good, state_.y1, state_.y1 + by);
        set_where(good, state_.y2, state_.y2 + by);
        out_.raise(!good);
    }

    std::complex<double> response(frequency f) const {
        const double angle = 2 * std::numbers::pi * f.value() * period_.value();
        return (1.0 - std::polar(1.0, -2 * angle)) / (2 * period_.value());
    }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    duration period_;
    quantity<si::frequency, Real> half_rate_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
