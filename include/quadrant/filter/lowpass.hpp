// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/fine_sum.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "slowest.hpp"

#include <cmath>
#include <complex>
#include <concepts>
#include <numbers>

namespace quadrant::inline v0 {

/// Smooths a wire: passes what is slower than the corner, takes 20 dB per decade off what is faster.
///   H(s) = w / (s + w), bilinear, pre-warped at w = 2 pi corner: -3 dB and -45 degrees sit exactly there.
///   y[k] = y[k-1] + t/(1+t) (x[k] + x[k-1] - 2 y[k-1]), t = tan(w T/2)
/// In steps towards the input, not as a sum of products: the gain at standstill is one exactly. In float the
/// output is a sum of two numbers (`fine_sum`), so that it reaches the input however small the steps are.
/// Source: [Franklin1998] ch. 6; LinuxCNC lowpass is the zero-order-hold form of the same filter.
/// Ports: one scalar in, one scalar out, the same signal; sign kept, gain one at standstill.
/// State: the last input and the last output; what has died out is zero; `reset` leaves zero, `settle(x)` the
/// state of a constant x. `retune(next)`: another corner from the next step on, jump = |b' - b| |x[k] +
/// x[k-1] - 2 y[k-1]|, b = t/(1+t). `shift(by)`: as if all inputs so far had been higher by so much.
/// Range: 0 < corner < half the sampling rate, in float from 3e-7 of the sampling rate on, in double from
/// 6e-16; zero gain at half the sampling rate.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "lowpass.corner = ...: must lie between 0 and half the sampling rate (...)", "must be at least ... of
/// the sampling rate in this number type (...)".
/// Cost: 1 multiplication, 16 bytes of state. Steeper: `butterworth`.
template <signal_tag Signal, class Real = double> class lowpass {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The corner, at which a sine is 3 dB down and 45 degrees late.
    struct parameters {
        quantity<hertz_unit, number> corner; ///< -3 dB; 0 < corner < half the sampling rate
    };
    /// The last input and output: all that a first-order filter remembers.
    struct state {
        value x{};                                      ///< last input
        fine_sum<value, std::same_as<Real, float>> y{}; ///< last output
    };

    lowpass(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("lowpass.period", period);
        require_below_nyquist("lowpass.corner", p.corner, period);
        require_held<Real>("lowpass.corner", p.corner, period);
        using std::tan;
        const number t = tan(number(std::numbers::pi * period.value()) * p.corner.value());
        b_ = Real(t / (1 + t));
    }

    value operator()(value x) noexcept {
        auto y = state_.y.plus(b_ * (state_.y.below(x) + state_.y.below(state_.x))).rested();
        const auto good = finite(y.high);
        if (none(good)) return out_.hold();
        y.high = unless_died_out(y.high);
        set_where(good, state_.x, x);
        set_where(good, state_.y, y);
        return out_.keep(good, y.high);
    }
    void reset() noexcept { settle(value()); }
    void settle(value x) noexcept {
        const auto good = finite(x);
        set_where(good, state_.x, x);
        set_where(good, state_.y, {x});
        out_.settle(good, x);
    }

    void retune(const lowpass& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        b_ = next.b_;
        given_ = next.given_;
    }
    void shift(value by) noexcept {
        const auto good = finite(by);
        set_where(good, state_.x, state_.x + by);
        set_where(good, state_.y.high, state_.y.high + by);
        out_.keep(good, out_.last() + by);
    }

    std::complex<double> response(frequency f) const {
        const std::complex<double> back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value());
        return detail::plain(b_) * (1.0 + back) / (1.0 - (1 - 2 * detail::plain(b_)) * back);
    }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    duration period_;
    Real b_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
