// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../error.hpp"
#include "../finite.hpp"
#include "second_order.hpp"

namespace quadrant {

/// Smooths a wire more steeply than `lowpass`: flat up to the corner, then 40 dB per decade.
///   H(s) = w^2 / (s^2 + sqrt(2) w s + w^2), bilinear, pre-warped at w = 2 pi corner: -3 dB and -90 degrees sit exactly there.
/// Source: [Franklin1998] ch. 6; the same as scipy.signal.butter(2, corner, fs=1/T).
/// Ports: one scalar in, one scalar out, the same signal; sign kept, gain one at standstill.
/// State: two numbers in the unit of the output (transposed direct form II); `reset` leaves zero, `settle(x)` the
/// state of a constant x.
/// Range: 0 < corner < half the sampling rate; a step overshoots by 4.3 %.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "butterworth.corner = ...: must lie between 0 and half the sampling rate (...)".
/// Cost: 5 multiplications, 16 bytes of state. Less phase lag: `lowpass`; one frequency only: `notch`.
template <signal_tag Signal, class Real = double> class butterworth {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The corner, at which a sine is 3 dB down and 90 degrees late.
    struct parameters {
        quantity<si::frequency, number> corner; ///< -3 dB; 0 < corner < half the sampling rate
    };
    using state = second_order_state<Signal, Real>;

    butterworth(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive("butterworth.period", period);
        require_below_nyquist("butterworth.corner", p.corner, period);
        using std::tan;
        const number t = tan(number(pi * period.value()) * p.corner.value()); // tan(w T/2)
        const number damping = std::numbers::sqrt2 * t, a0 = 1 + damping + t * t;
        const Real a1 = Real(2 * (t * t - 1) / a0), a2 = Real((1 - damping + t * t) / a0);
        const Real sum =
            (1 + a1) + a2; // 4 t^2 / a0, without rounding: the gain at standstill is one, in float too
        coefficients_ = {.b0 = sum / 4, .b1 = sum / 2, .b2 = sum / 4, .a1 = a1, .a2 = a2};
    }

    value operator()(value x) noexcept { return step(coefficients_, state_, out_, x); }
    void reset() noexcept { settle(value()); }
    void settle(value x) noexcept { quadrant::settle(coefficients_, state_, out_, x); }
    void retune(const butterworth& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        quadrant::retune(coefficients_, next.coefficients_, state_, out_.last());
        given_ = next.given_;
    }
    void shift(value by) noexcept { quadrant::shift(coefficients_, state_, out_, by); }

    std::complex<double> response(frequency f) const { return quadrant::response(coefficients_, f, period_); }
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

} // namespace quadrant
