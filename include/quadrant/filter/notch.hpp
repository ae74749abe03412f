// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../error.hpp"
#include "../finite.hpp"
#include "second_order.hpp"

namespace quadrant {

/// Takes one structural resonance out of a wire: zero gain at the centre, one far from it.
///   H(s) = (s^2 + w^2) / (s^2 + damping w s + w^2), bilinear, pre-warped at w = 2 pi centre: the zero sits exactly there.
/// Source: gap/FORMAT.md (controller kind cascade_p_pi); bilinear form [Franklin1998] ch. 6.
/// Ports: one scalar in, one scalar out, the same signal; sign kept.
/// State: two numbers in the unit of the output (transposed direct form II); `reset` leaves zero, `settle(x)` the
/// state of a constant x (gain one at standstill).
/// `retune(next)`: the parameters of another notch from the next step on, J = |b0' - b0| |x[k] - x[k-1]|. `shift(by)`: as if all
/// inputs so far had been higher by so much.
/// Range: 0 < centre < half the sampling rate, damping > 0 (-3 dB width = damping times centre, in hertz).
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Cost: 4 multiplications (b0 = b2, b1 = a1), 24 bytes of state. For a dip of limited depth use `transfer_function`.
template <signal_tag Signal, class Real = double> class notch {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The resonance to take out: where it is, and how wide.
    struct parameters {
        quadrant::quantity<si::frequency, number>
            centre;           ///< deepest point; 0 < centre < half the sampling rate
        number damping = 0.1; ///< of the denominator, twice its damping ratio; > 0
    };
    using state = second_order_state<Signal, Real>;

    notch(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive("notch.period", period);
        require_below_nyquist("notch.centre", p.centre, period);
        require_positive("notch.damping", p.damping);
        using std::tan;
        const number t = tan(number(pi * period.value()) * p.centre.value()); // tan(w T/2)
        const number a0 = 1 + p.damping * t + t * t;
        const Real a1 = Real(2 * (t * t - 1) / a0);
        // b0 = (1 + a2) / 2 after rounding, so that the gain at standstill is one, in float too.
        const Real b0 = Real((1 + t * t) / a0), a2 = (b0 + b0) - 1;
        coefficients_ = {.b0 = b0, .b1 = a1, .b2 = b0, .a1 = a1, .a2 = a2};
    }

    value operator()(value x) noexcept { return step(coefficients_, state_, out_, x); }
    void reset() noexcept { settle(value()); }
    void settle(value x) noexcept { quadrant::settle(coefficients_, state_, out_, x); }
    void retune(const notch& next) noexcept {
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
