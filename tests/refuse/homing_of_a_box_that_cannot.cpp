// SPDX-License-Identifier: BSL-1.0
// A velocity estimator of the user without `shift`: a cascade runs with it, and its frame cannot move (homing).
// MUST SAY: shiftable_axis_boxes
// MUST SAY: decltype (B::measured_velocity) | decltype(B::measured_velocity)
// MUST SAY: shiftable<
// AT MOST: gcc 3800, clang 1100
#include "quadrant/loop/cascade_p_pi.hpp"
using namespace quadrant;

struct my_estimator {
    quantity_of<signal::velocity> operator()(const quantity_of<signal::position>&) { return {}; }
    void reset() {}
#ifdef MEND
    void shift(const quantity_of<signal::position>&) {}
#endif
};
struct my_axis : cascade_p_pi_boxes<> {
    using cascade_p_pi_boxes<>::cascade_p_pi_boxes;
    my_estimator measured_velocity;
};
static_assert(axis_boxes<my_axis>);
void homed(cascade<my_axis>& axis, quantity_of<signal::position> by) { axis.shift(by); }
