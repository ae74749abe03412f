// SPDX-License-Identifier: BSL-1.0
// A set of boxes without friction: the message names the member.
// MUST SAY: decltype (B::friction) | no member named 'friction'
// MUST SAY: axis_boxes
// AT MOST: gcc 1400, clang 800
#include "quadrant/loop/cascade_p_pi.hpp"
using namespace quadrant;

struct my_axis {
    backward_difference<signal::position, signal::velocity> reference_velocity;
    backward_difference<signal::velocity, signal::acceleration> reference_acceleration;
    filtered_derivative<signal::position, signal::velocity> measured_velocity;
    proportional<signal::position, signal::velocity> position_loop;
    proportional<signal::velocity, signal::velocity> velocity_feedforward;
    proportional_integral<signal::velocity, signal::voltage> velocity_loop;
    notch<signal::voltage> resonance;
    proportional<signal::acceleration, signal::voltage> acceleration_feedforward;
#ifdef MEND
    absent<signal::velocity, signal::voltage> friction;
#endif
    limiter<signal::voltage> amplifier;
    quantizer<signal::voltage> dac;
};
static_assert(axis_boxes<my_axis>);
