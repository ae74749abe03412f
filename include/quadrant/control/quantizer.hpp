// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/whole.hpp"

#include <cmath>

namespace quadrant::inline v0 {

/// Rounds a wire to the steps of a DAC or an encoder.
///   y = round(x / step) step, halves away from zero; step = 0: y = x
/// Lanes that step together multiply by 1 / step and round halves to the even count.
/// Source: docs/formats.md (DAC rounding of cascade_p_pi).
/// Ports: one scalar in, one scalar out, the same signal.
/// State: none; `reset` and `settle` set the held output and clear the fault.
/// Range: step >= 0; from 2^52 steps on (2^23 in float) the input is its own rounding. A dual's derivative
/// passes unchanged.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "quantizer.step = ...: must be finite and not below 0".
/// Cost: 1 division, 1 rounding, 1 multiplication. To bound the range as a real DAC does, put a `limiter`
/// before it.
template <signal_tag Signal, class Real = double> class quantizer {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The step, in the unit of the wire.
    struct parameters {
        quantity_of<Signal, number> step; ///< one count; 0 = no rounding
    };
    struct state {};

    quantizer(const parameters& p, duration period) : given_(p), step_(in_real<Real>(p.step)) {
        require_positive<Real>("quantizer.period", period);
        require_not_negative<Real>("quantizer.step", p.step);
    }

    value operator()(value x) noexcept {
        const value y = rounded(x);
        return out_.keep(finite(x, y), y);
    }
    void reset() noexcept { out_.reset(); }
    void settle(value x) noexcept {
        const value y = rounded(x);
        out_.settle(finite(x, y), y);
    }
    void retune(const quantizer& next) noexcept { ///< jump <= half of both steps
        step_ = next.step_;
        rounds_ = next.rounds_;
        inverse_step_ = next.inverse_step_;
        given_ = next.given_;
    }

    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    value rounded(value x) const noexcept {
        if constexpr (!multi_lane<Real>) // in lanes the division is done for nothing
            if (none(rounds_)) return x;
        // Off by a step where a division would meet the middle between two of them.
        if constexpr (steps_together<Real>) {
            const Real whole = nearest(Real(x * inverse_step_));
            return select(rounds_, value(whole * step_), x);
        } else
            return select(rounds_, value(detail::whole(Real(x / step_)) * step_), x);
    }

    parameters given_;
    value step_;
    mask_of<Real> rounds_ = greater(step_, value()); ///< where there is a step at all
    decltype(Real(1) / value()) inverse_step_ = Real(1) / step_;
    held_output<value, false> out_;
};

} // namespace quadrant::inline v0
