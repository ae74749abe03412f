// SPDX-License-Identifier: BSL-1.0
// A Ferraris estimator in the slot `disturbance`: the axis has to be called with the measured acceleration.
// MUST SAY: takes_acceleration
// AT MOST: gcc 2400, clang 2400
#include "quadrant/loop/milling_axis_boxes.hpp"
#include "quadrant/observer/ferraris_force_estimator.hpp"
using namespace quadrant;

using sensed = milling_axis<
    milling_axis_boxes<absent<signal::velocity, signal::voltage>, ferraris_force_estimator<signal::voltage>>>;
quantity_of<signal::voltage> step(sensed& axis, const sensed::motion& r, quantity_of<signal::position> measured,
                                  quantity_of<signal::acceleration> accelerated) {
#ifdef MEND
    return axis(r, r, measured, accelerated);
#else
    static_cast<void>(accelerated);
    return axis(r, r, measured);
#endif
}
