// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../block/axis_motion.hpp"
#include "../observer/nominal_plant.hpp"

#include <complex>
#include <numbers>

namespace quadrant::inline v0 {

/// The command that moves the nominal axis as the trajectory asks, before there is an error: mass and viscous
/// friction.
///   u = (r'' + A r') / B, the inverse of Gn(s) = B / (s (s + A))
/// Source: [Jamaludin2008] eq. (2.2), inverse-model feedforward.
/// Ports: velocity and acceleration of the trajectory in, one by one or as a motion; command out, sign of the
/// motion. Given `ahead` of a `preview`, by the delay of the plant and its hold, the linear part of the error
/// is zero.
/// State: none; `reset` and `settle` set the held output and clear the fault.
/// Range: B > 0, A >= 0 in 1/s (not hertz). A disturbance observer beside it needs the same A and B: take both
/// from one `axis_model`.
/// `retune(next)`: another plant from the next step on; jump: |(1/B' - 1/B) a + (A'/B' - A/B) v|.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "inverse_model.gain = ...: must ...", "inverse_model.viscous_rate = ...: must ..." and for the
/// period.
/// Cost: 2 multiplications. One `proportional` on either derivative is the same in two boxes (`milling_axis`:
/// inertia and drag). From positions alone: `sampled_inverse_model`.
template <signal_tag Command, class Real = double> class inverse_model {
public:
    using output = Command;
    using value = quantity_of<Command, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using acceleration = quantity_of<signal::acceleration, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using parameters = axis_model<Command, number>;
    struct state {};

    inverse_model(const parameters& p, duration period) : given_(p) {
        require_positive<Real>("inverse_model.period", period);
        require_positive<Real>("inverse_model.gain", p.gain);
        require_not_negative<Real>("inverse_model.viscous_rate", p.viscous_rate);
        inertia_ = in_real<Real>(gain_of<Command, signal::acceleration, number>(number(1) / p.gain));
        drag_ = in_real<Real>(gain_of<Command, signal::velocity, number>(p.viscous_rate / p.gain));
    }

    value operator()(velocity v, acceleration a) noexcept {
        const value u = inertia_ * a + drag_ * v;
        return out_.keep(finite(u), u);
    }
    template <motion_sample Motion> value operator()(const Motion& r) noexcept {
        return (*this)(r.velocity, r.acceleration);
    }
    void reset() noexcept { out_.reset(); }
    void settle(velocity v, acceleration a) noexcept {
        const value u = inertia_ * a + drag_ * v;
        out_.settle(finite(u), u);
    }

    void retune(const inverse_model& next) noexcept {
        const auto out = out_;
        *this = next;
        out_ = out;
    }

    /// From the position of a trajectory that knows its derivatives.
    std::complex<double> response(frequency f) const {
        const std::complex<double> s(0, 2 * std::numbers::pi * f.value());
        return s * (s * detail::plain(inertia_) + detail::plain(drag_));
    }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    parameters given_;
    gain_of<Command, signal::acceleration, Real> inertia_;
    gain_of<Command, signal::velocity, Real> drag_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
