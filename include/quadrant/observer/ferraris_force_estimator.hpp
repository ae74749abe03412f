// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "../filter/slowest.hpp"
#include "../filter/transfer_function.hpp"
#include "q_filter.hpp"

#include <complex>
#include <cstddef>

namespace quadrant::inline v0 {

/// What pushes the mass, from its acceleration (Ferraris sensor), the command and the friction: no model of the
/// axis' dynamics, no differentiated encoder.
///   d = Q (M a - kf u + friction),   Q(s) = sum_{i=0..m} q_i s^i / (s + wc)^n, bilinear, as in `disturbance_observer`
///   wire.force   = box.ferraris(acceleration, wire.command, wire.friction);   // z^-1: the command that acts at this sample
///   wire.command = wire.wanted - box.ferraris.command();
/// Nothing to solve: an acceleration sampled before the new command goes out shows the last one.
/// Source: [Jamaludin2008] eq. (5.6); calibration of the sensor: `analysis/ferraris_calibration.hpp`.
/// Ports: acceleration in, force out; second and third argument the command that acts at this sample (of a
/// delayed axis: through a `delay_line`) and the friction force, positive against positive motion; d is
/// positive in the direction of positive motion.
/// State: that of Q, n forces; `reset` leaves zero; `settle(a)` the state of a constant a without command and
/// friction, `settle(a, u)` under a constant command. In the slot `disturbance` of a `milling_axis`: its second
/// argument is what acts at this sample without the friction that was fed forward, so friction is not in it.
/// `retune(next)`: another corner, mass or force constant from the next step on; the force is off by b0'
/// (f'[k] - f[k-1]) - b0 (f[k] - f[k-1]) from what it would have been, f = M a - kf u + friction, f' with the
/// new numbers, b0 the first coefficient of Q.
/// Range: 0 < corner < half the sampling rate; m < n. An offset Z of the sensor becomes a force M Z.
/// NaN and infinities in any argument: holds the last force, keeps the state, raises faulted().
/// Throws "ferraris_force_estimator.<field> = ...: must ..." for period, mass, force_constant, corner.
/// Cost: 2 n + 3 multiplications. Without the sensor: `disturbance_observer`; with a position beside it:
/// `reduced_order_observer`.
template <signal_tag Command, std::size_t Order = 2, std::size_t NumeratorOrder = 0, class Real = double>
requires(NumeratorOrder < Order) class ferraris_force_estimator {
public:
    using input = signal::acceleration;
    using output = signal::force;
    using argument = quantity_of<signal::acceleration, Real>;
    using value = quantity_of<signal::force, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using applied = quantity_of<Command, Real>;

    /// Mass and motor that the force is computed by, and the corner of its filter.
    struct parameters {
        quantity<si::mass, number> mass;                        ///< > 0
        gain_of<signal::force, Command, number> force_constant; ///< kf > 0
        quantity<hertz_unit, number> corner; ///< wc / (2 pi); 0 < corner < half the sampling rate
    };
    static constexpr bool takes_acceleration = true; ///< a loop feeds the measured acceleration
    using low_pass = transfer_function<signal::force, signal::force, Order, Real>;
    using state = typename low_pass::state;

    ferraris_force_estimator(const parameters& p, duration period)
        : given_(checked(p, period)), period_(period), mass_(in_real<Real>(p.mass)),
          force_constant_(in_real<Real>(p.force_constant)),
          q_(low_pass::of(bilinear_differences(q_filter<Order, NumeratorOrder>(p.corner), period), period)) {}

    value operator()(argument acceleration, applied u = applied(), value friction = value()) noexcept {
        return last_ = q_(mass_ * acceleration - force_constant_ * u + friction);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument acceleration) noexcept { settle(acceleration, applied()); }
    void settle(argument acceleration, applied u) noexcept {
        const value force = mass_ * acceleration - force_constant_ * u;
        q_.settle(force);
        if (finite(force)) last_ = force;
    }

    void retune(const ferraris_force_estimator& next) noexcept {
        q_.retune(next.q_); // of another period: raises its fault
        if (next.period_ != period_) return;
        given_ = next.given_;
        mass_ = next.mass_;
        force_constant_ = next.force_constant_;
    }

    /// The force as a command, to be subtracted from the wanted one.
    applied command() const noexcept { return last_ / force_constant_; }
    std::complex<double> response(frequency f) const { return detail::plain(mass_) * q_.response(f); }
    bool faulted() const noexcept { return q_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return q_.now(); }

private:
    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("ferraris_force_estimator.period", period);
        require_positive<Real>("ferraris_force_estimator.mass", p.mass);
        require_positive<Real>("ferraris_force_estimator.force_constant", p.force_constant);
        require_below_nyquist("ferraris_force_estimator.corner", p.corner, period);
        require_held<Real>("ferraris_force_estimator.corner", p.corner, period);
        return p;
    }

    parameters given_;
    duration period_;
    quantity<si::mass, Real> mass_;
    gain_of<signal::force, Command, Real> force_constant_;
    low_pass q_;
    value last_{};
};

} // namespace quadrant::inline v0
