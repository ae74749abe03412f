// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/fine_sum.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "second_order.hpp"

#include <complex>

namespace quadrant::inline v0 {

/// Takes one structural resonance out of a wire: zero gain at the centre, one far from it.
///   H(s) = (s^2 + w^2) / (s^2 + width w s + w^2), bilinear, pre-warped at w = 2 pi centre: the zero sits exactly there.
/// Source: docs/formats.md (controller kind cascade_p_pi); bilinear form [Franklin1998] ch. 6.
/// Ports: one scalar in, one scalar out, the same signal; sign kept.
///   y = x - width band,  the band from two integrators in a ring (`second_order.hpp`), a constant passes to the last bit
/// State: last input, how far it is ahead of the slow part, and the band, in the unit of the input; `reset`
/// leaves zero, `settle(x)` the state of a constant x (gain one at standstill). What has died out is zero.
/// `retune(next)`: the parameters of another notch from the next step on, jump = |b0' - b0| |x[k] - x[k-1]|.
/// `shift(by)`: as if all inputs so far had been higher by so much.
/// Range: 0 < centre < half the sampling rate, width > 0 (-3 dB over width times centre, in hertz). In
/// float the centre may lie down to 3e-7 of the sampling rate (width 1 and above; else by width less), in
/// double to 6e-16.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "notch.centre = ...: must lie between 0 and half the sampling rate (...)", "must be at least ... of
/// the sampling rate in this number type (...)", "notch.width = ...: must be finite and above 0".
/// Cost: 4 multiplications, 8 additions, 24 bytes of state. For a dip of limited depth use `transfer_function`.
template <signal_tag Signal, class Real = double> class notch {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The resonance to take out: where it is, and how wide.
    struct parameters {
        quadrant::quantity<hertz_unit, number> centre; ///< deepest point; 0 < centre < half the sampling rate
        number width = 0.1; ///< between the -3 dB points, relative to the centre; > 0. Twice the damping ratio
    };
    /// What the slow part lags behind, the band, and the last input.
    struct state {
        value ahead{}; ///< last input minus the slow part: zero at rest
        value band{};  ///< zero at rest
        value input{};
    };

    notch(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("notch.period", period);
        require_below_nyquist("notch.centre", p.centre, period);
        require_positive<Real>("notch.width", p.width);
        coefficients_ = second_order<Real>("notch.centre", p.centre, p.width, period);
    }

    value operator()(value x) noexcept {
        const value ahead = state_.ahead + detail::rounded_here<value>(x - state_.input);
        const value half = coefficients_.thrust * (ahead - coefficients_.brake * state_.band);
        const value middle = state_.band + half, rise = coefficients_.g * middle;
        const value y = x - coefficients_.damping * middle;
        value left = ahead - (rise + rise), band = middle + half;
        const auto good = finite(y, left, band);
        if (none(good)) return out_.hold();
        if (const auto still = died_out(left, band); any(still)) {
            set_where(still, left, value());
            set_where(still, band, value());
        }
        set_where(good, state_.ahead, left);
        set_where(good, state_.band, band);
        set_where(good, state_.input, x);
        return out_.keep(good, y);
    }
    void reset() noexcept { settle(value()); }
    void settle(value x) noexcept {
        const auto good = finite(x);
        set_where(good, state_.ahead, value());
        set_where(good, state_.band, value());
        set_where(good, state_.input, x);
        out_.settle(good, x);
    }
    void retune(const notch& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        const value band = retuned_band(coefficients_, next.coefficients_, coefficients_.damping,
                                        next.coefficients_.damping, state_.ahead, state_.band);
        set_where(finite(band), state_.band, band);
        coefficients_ = next.coefficients_;
        given_ = next.given_;
    }
    void shift(value by) noexcept {
        const auto good = finite(by);
        set_where(good, state_.input, state_.input + by);
        out_.shift(good, by);
    }

    std::complex<double> response(frequency f) const {
        return 1.0 - detail::plain(coefficients_.damping) * quadrant::response(coefficients_, f, period_).band;
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
    held_output<value, false> out_;
};

} // namespace quadrant::inline v0
