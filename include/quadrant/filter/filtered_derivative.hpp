// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "slowest.hpp"

#include <complex>
#include <numbers>

namespace quadrant::inline v0 {

/// Velocity from an encoder: a derivative behind a first-order low-pass.
///   H(s) = wc s / (s + wc), wc = 2 pi corner, bilinear without pre-warp:
///   v[k] = v[k-1] + 2 wc (y[k] - y[k-1] - T v[k-1]) / (2 + wc T)
/// Source: docs/formats.md (velocity_estimator filtered_derivative).
/// Ports: one scalar in, its rate out; sign kept.
/// State: the last input and the last output; a rate that has died out is zero; `reset` leaves 0, so a first
/// sample y0 reads as a jump: `settle(y0)` first. `settle(y)` stands still at y; `settle(y, rate)` has been
/// moving at that rate and y was its last sample. `retune(next)`: another corner from the next step on,
/// jump = |b' - b| |(y[k] - y[k-1])/T - v[k-1]|, b = 2 wc T/(2 + wc T): none in even motion. `shift(by)`: the
/// frame of
///   positions moves, the rate does not.
/// Range: corner > 0. Above the sampling rate / pi (wc T > 2) the pole is negative and the output rings, but
/// decays. The gain of a ramp is exactly one; the -3 dB point lies below corner by the bilinear warp.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "filtered_derivative.corner = ...: must be finite and above 0", "must be at least ... of the sampling
/// rate in this number type (...)" (3e-7 in float, 6e-16 in double).
/// Cost: 2 multiplications, 3 additions, 16 bytes of state. Shorter delay, more noise: `two_sample_derivative`.
template <signal_tag In, rate_of<In> Out, class Real = double> class filtered_derivative {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The corner of the low-pass.
    struct parameters {
        quantity<hertz_unit, number> corner; ///< > 0
    };
    /// The last position and rate: what a difference and its filter need.
    struct state {
        argument y{}; ///< last input
        value v{};    ///< last output
    };

    filtered_derivative(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("filtered_derivative.period", period);
        require_positive<Real>("filtered_derivative.corner", p.corner);
        require_held<Real>("filtered_derivative.corner", p.corner, period);
        const number wc = number(2 * std::numbers::pi) * p.corner.value(), wt = wc * number(period.value());
        lose_ = Real(2 * wt / (2 + wt));
        take_ = quantity<si::frequency, Real>::from_value(Real(2 * wc / (2 + wt)));
    }

    value operator()(argument y) noexcept {
        const value next = state_.v + (take_ * (y - state_.y) - lose_ * state_.v);
        const auto good = finite(next);
        if (none(good)) return out_.hold();
        const value v = unless_died_out(next);
        set_where(good, state_.y, y);
        set_where(good, state_.v, v);
        return out_.keep(good, v);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument y) noexcept { settle(y, value()); }
    void settle(argument y, value rate) noexcept {
        const auto good = finite(y, rate);
        set_where(good, state_.y, y);
        set_where(good, state_.v, rate);
        out_.settle(good, rate);
    }
    void retune(const filtered_derivative& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        lose_ = next.lose_;
        take_ = next.take_;
        given_ = next.given_;
    }
    void shift(argument by) noexcept {
        const auto good = finite(by);
        set_where(good, state_.y, state_.y + by);
        out_.raise(!good);
    }

    std::complex<double> response(frequency f) const {
        const std::complex<double> back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value());
        return detail::plain(take_) * (1.0 - back) / (1.0 - (1 - detail::plain(lose_)) * back);
    }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    duration period_;
    Real lose_; ///< take T: a ramp comes out as it is
    quantity<si::frequency, Real> take_;
    state state_;
    held_output<value, false> out_;
};

} // namespace quadrant::inline v0
