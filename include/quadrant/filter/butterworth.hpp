// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/fine_sum.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "second_order.hpp"

#include <complex>
#include <numbers>

namespace quadrant::inline v0 {

/// Smooths a wire more steeply than `lowpass`: flat up to the corner, then 40 dB per decade.
///   H(s) = w^2 / (s^2 + sqrt(2) w s + w^2), bilinear, pre-warped at w = 2 pi corner: -3 dB and -90 degrees sit exactly there.
/// Source: [Franklin1998] ch. 6; the same as scipy.signal.butter(2, corner, fs=1/T).
/// Ports: one scalar in, one scalar out, the same signal; sign kept, gain one at standstill.
/// Two integrators in a ring (`second_order.hpp`): a constant passes to the last bit.
/// State: low-pass (two numbers), band and last input, in the unit of the input; `reset` leaves zero,
/// `settle(x)` the state of a constant x. What has died out is zero.
/// `retune(next)`: another corner from the next step on, jump = |b0' - b0| |x[k] - x[k-1]|. `shift(by)`: as if
/// all inputs so far had been higher by so much.
/// Range: 0 < corner < half the sampling rate, in float from 3e-7 of the sampling rate on, in double from
/// 6e-16; a step overshoots by 4.3 %.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "butterworth.corner = ...: must lie between 0 and half the sampling rate (...)", "must be at least
/// ... of the sampling rate in this number type (...)".
/// Cost: 3 multiplications, 12 additions, 32 bytes of state. Less phase lag: `lowpass`; one frequency only:
/// `notch`.
template <signal_tag Signal, class Real = double> class butterworth {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The corner, at which a sine is 3 dB down and 90 degrees late.
    struct parameters {
        quantity<hertz_unit, number> corner; ///< -3 dB; 0 < corner < half the sampling rate
    };
    /// The slow part, which is what comes out, the band, and the last input.
    struct state {
        fine_sum<value> slow{};
        value band{}; ///< zero at rest
        value input{};
    };

    butterworth(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("butterworth.period", period);
        require_below_nyquist("butterworth.corner", p.corner, period);
        coefficients_ = second_order<Real>("butterworth.corner", p.corner, number(std::numbers::sqrt2), period);
    }

    value operator()(value x) noexcept {
        const value ahead = state_.slow.below(x);
        const value half = coefficients_.thrust * (ahead - coefficients_.brake * state_.band);
        const value middle = state_.band + half, rise = coefficients_.g * middle;
        const value y = state_.slow.with(rise);
        fine_sum<value> slow = state_.slow.plus(rise + rise);
        value band = middle + half;
        const auto good = finite(y, slow.high, band);
        if (none(good)) return out_.hold();
        if (const auto still = died_out(ahead, band); any(still)) {
            set_where(still, slow, {x});
            set_where(still, band, value());
        }
        set_where(good, state_.slow, slow);
        set_where(good, state_.band, band);
        set_where(good, state_.input, x);
        return out_.keep(good, y);
    }
    void reset() noexcept { settle(value()); }
    void settle(value x) noexcept {
        const auto good = finite(x);
        set_where(good, state_.slow, {x});
        set_where(good, state_.band, value());
        set_where(good, state_.input, x);
        out_.settle(good, x);
    }
    void retune(const butterworth& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        const value band = retuned_band(coefficients_, next.coefficients_, coefficients_.g,
                                        next.coefficients_.g, state_.slow.below(state_.input), state_.band);
        set_where(finite(band), state_.band, band);
        coefficients_ = next.coefficients_;
        given_ = next.given_;
    }
    void shift(value by) noexcept {
        const auto good = finite(by);
        set_where(good, state_.slow.high, state_.slow.high + by);
        set_where(good, state_.input, state_.input + by);
        out_.keep(good, out_.last() + by);
    }

    std::complex<double> response(frequency f) const {
        return quadrant::response(coefficients_, f, period_).slow;
    }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    duration period_;
    second_order_coefficients<Real> coefficients_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
