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
#include "milling_axis.hpp"

namespace quadrant::inline v0 {

namespace detail {
/// The boxes that estimate the velocities of an axis: one for each role; in lanes that step together one for
/// all (`loop/velocity_pair.hpp`).
template <class Real> struct velocity_boxes {
    velocity_boxes(const auto& p, duration period)
        : reference_velocity({p.estimator_corner}, period), reference_notch(p.notch, period),
          measured_velocity({p.estimator_corner}, period), measured_notch(p.notch, period) {}

    filtered_derivative<signal::position, signal::velocity, Real> reference_velocity;
    quadrant::notch<signal::velocity, Real> reference_notch;
    filtered_derivative<signal::position, signal::velocity, Real> measured_velocity;
    quadrant::notch<signal::velocity, Real> measured_notch;
};
} // namespace detail

/// The stock boxes of a `milling_axis`, from flat parameters as the thesis prints them:
///   milling_axis<milling_axis_boxes<maxwell_slip<4, signal::velocity, signal::voltage>>> x{.box = {parameters, 500_us}};
/// Friction: any law from velocity to the command (`stribeck`, `dahl`, `lugre`, `maxwell_slip`), or `absent`.
/// Disturbance: `disturbance_observer`, or `absent`. Memory: `repetitive<signal::position, ...>`, or `absent`.
/// The plant is B / (s (s + A)), command to position: `plant_gain` B, `plant_pole` A.
/// For another set of boxes write a struct with the same member names; see `milling_boxes`.
template <class Friction = absent<signal::velocity, signal::voltage>,
          class Disturbance = absent<signal::position, signal::voltage>,
          class Memory = absent<signal::position, signal::position>, class Real = double,
          signal_tag Command = signal::voltage>
struct milling_axis_boxes : detail::velocity_boxes<Real> {
    using number = parameter_real<Real>; ///< of parameters

    /// Gains, filters and compensations of a milling axis, as the thesis prints them.
    struct parameters {
        gain_of<signal::velocity, signal::position, number> position_gain; ///< kv
        gain_of<Command, signal::velocity, number> velocity_gain;          ///< kp
        gain_rate_of<Command, signal::velocity, number> velocity_integral; ///< ki
        quantity<hertz_unit, number> estimator_corner; ///< of Vest, on reference and measurement
        typename quadrant::notch<signal::velocity, Real>::parameters notch; ///< behind both
        gain_of<signal::acceleration, Command, number> plant_gain;          ///< B, > 0
        quantity<si::frequency, number> plant_pole{};                       ///< A, in 1/s; >= 0
        typename Friction::parameters friction{};
        typename Disturbance::parameters disturbance{};
        typename Memory::parameters memory{};
        quantity_of<Command, number> limit;      ///< of command and integral, > 0; may be infinite
        quantity_of<Command, number> dac_step{}; ///< 0 = no rounding
    };

    milling_axis_boxes(const parameters& p, duration period)
        : detail::velocity_boxes<Real>(p, period), memory(p.memory, period),
          position_loop({p.position_gain}, period),
          velocity_loop({p.velocity_gain, p.velocity_integral, p.limit}, period),
          inertia({number(1) / checked(p)}, period), drag({p.plant_pole / p.plant_gain}, period),
          disturbance(p.disturbance, period), travel({}, period), friction(p.friction, period),
          amplifier({-p.limit, p.limit}, period), dac({p.dac_step}, period) {}

    Memory memory;
    proportional<signal::position, signal::velocity, Real> position_loop;
    proportional_integral<signal::velocity, Command, integral_clamp, Real> velocity_loop;
    proportional<signal::acceleration, Command, Real> inertia;
    proportional<signal::velocity, Command, Real> drag;
    Disturbance disturbance;
    backward_difference<signal::position, signal::velocity, Real> travel;
    Friction friction;
    limiter<Command, Real> amplifier;
    quantizer<Command, Real> dac;

private:
    static auto checked(const parameters& p) {
        require_positive<Real>("milling_axis_boxes.plant_gain", p.plant_gain);
        require_not_negative<Real>("milling_axis_boxes.plant_pole", p.plant_pole);
        return p.plant_gain;
    }
};
static_assert(milling_boxes<milling_axis_boxes<>>);

} // namespace quadrant::inline v0
