// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <complex>
#include <numbers>

namespace quadrant::inline v0 {

/// Rate of change over the last period: reference velocity and acceleration, or a velocity from an encoder.
///   v[k] = (x[k] - x[k-1]) / T
/// Source: docs/formats.md (v_ref and a_ref of cascade_p_pi).
/// Ports: one scalar in, its rate out (m -> m/s, m/s -> m/s^2); sign kept.
/// State: the last input; `reset` leaves 0, so a first sample x0 reads as x0 / T: `settle(x0)` first.
/// `settle(x)` stands still at x; `settle(x, rate)` has been moving at that rate and x was its last sample.
/// Range: late by half a period; a count q of the encoder reads q / T of velocity.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "backward_difference.period = ...: must be finite and above 0".
/// Cost: 1 multiplication, 8 bytes of state. Less noise: `filtered_derivative`, `two_sample_derivative`.
template <signal_tag In, rate_of<In> Out, class Real = double> class backward_difference {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    struct parameters {};
    /// The last input, which is taken from the next one.
    struct state {
        argument x{}; ///< last input
    };

    backward_difference(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("backward_difference.period", period);
        rate_ = quantity<si::frequency, Real>::from_value(Real(1 / period.value()));
    }

    value operator()(argument x) noexcept {
        const value v = rate_ * (x - state_.x);
        const auto good = finite(v);
        if (none(good)) return out_.hold();
        set_where(good, state_.x, x);
        return out_.keep(good, v);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument x) noexcept { settle(x, value()); }
    void settle(argument x, value rate) noexcept {
        const auto good = finite(x, rate);
        set_where(good, state_.x, x);
        out_.settle(good, rate);
    }
    void shift(argument by) noexcept {
        const auto good = finite(by);
        set_where(good, state_.x, state_.x + by);
        out_.raise(!good);
    }

    std::complex<double> response(frequency f) const {
        const double angle = 2 * std::numbers::pi * f.value() * period_.value();
        return (1.0 - std::polar(1.0, -angle)) / period_.value();
    }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    duration period_;
    quantity<si::frequency, Real> rate_;
    state state_;
    held_output<value, false> out_;
};

} // namespace quadrant::inline v0
