// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../block/absent.hpp"
#include "../control/limiter.hpp"
#include "../control/proportional.hpp"
#include "../control/proportional_integral.hpp"
#include "../control/quantizer.hpp"
#include "../filter/backward_difference.hpp"
#include "../filter/filtered_derivative.hpp"
#include "../filter/notch.hpp"
#include "../friction/coulomb_viscous.hpp"
#include "cascade.hpp"

namespace quadrant::inline v0 {

/// The stock boxes of a `cascade`, from the flat parameters of a machine file (controller kind cascade_p_pi):
///   cascade<cascade_p_pi_boxes<>> axis{.box = {parameters, 500_us}};
/// Estimator: `filtered_derivative`, `two_sample_derivative` or `backward_difference`. Notch: `through` (none),
/// `notch`, `series<notch, notch>`. Command: volts, or `signal::current`, `signal::force` for a drive that
/// takes them. For another set of boxes write a struct with the same member names; see `axis_boxes`.
template <class Estimator = filtered_derivative<signal::position, signal::velocity>,
          class Notch = through<signal::voltage>, class Real = real_of<Estimator>,
          signal_tag Command = typename Notch::input>
struct cascade_p_pi_boxes {
    using number = parameter_real<Real>; ///< of parameters

    /// Gains, estimator, feedforward and limits of a cascade, as the keys of a machine file.
    struct parameters {
        gain_of<signal::velocity, signal::position, number> position_gain;
        gain_of<Command, signal::velocity, number> velocity_gain;
        gain_rate_of<Command, signal::velocity, number> velocity_integral;
        typename Estimator::parameters estimator{};
        number velocity_feedforward = 1;
        gain_of<Command, signal::acceleration, number> acceleration_feedforward{};
        gain_of<Command, signal::velocity, number> viscous_feedforward{};
        quantity_of<Command, number> coulomb_feedforward{};
        typename Notch::parameters notch{};
        quantity_of<Command, number> limit;      ///< of command and integral, > 0; may be infinite
        quantity_of<Command, number> dac_step{}; ///< 0 = no rounding
    };

    cascade_p_pi_boxes(const parameters& p, duration period)
        : reference_velocity({}, period), reference_acceleration({}, period),
          measured_velocity(p.estimator, period), position_loop({p.position_gain}, period),
          velocity_feedforward({p.velocity_feedforward}, period),
          velocity_loop({p.velocity_gain, p.velocity_integral, p.limit}, period), resonance(p.notch, period),
          acceleration_feedforward({p.acceleration_feedforward}, period),
          friction({p.coulomb_feedforward, p.viscous_feedforward}, period),
          amplifier({-p.limit, p.limit}, period), dac({p.dac_step}, period) {}

    backward_difference<signal::position, signal::velocity, Real> reference_velocity;
    backward_difference<signal::velocity, signal::acceleration, Real> reference_acceleration;
    Estimator measured_velocity;
    proportional<signal::position, signal::velocity, Real> position_loop;
    proportional<signal::velocity, signal::velocity, Real> velocity_feedforward;
    proportional_integral<signal::velocity, Command, integral_clamp, Real> velocity_loop;
    Notch resonance;
    proportional<signal::acceleration, Command, Real> acceleration_feedforward;
    coulomb_viscous<signal::velocity, Command, Real> friction;
    limiter<Command, Real> amplifier;
    quantizer<Command, Real> dac;
};
static_assert(axis_boxes<cascade_p_pi_boxes<>>);

} // namespace quadrant::inline v0
