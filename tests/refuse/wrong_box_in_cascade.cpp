// SPDX-License-Identifier: BSL-1.0
// A position loop that puts out a force sits where the cascade wants a velocity.
// MUST SAY: decltype (B::position_loop) | decltype(my_axis::position_loop)
// MUST SAY: maps<
// MUST SAY: axis_boxes
// AT MOST: gcc 1400, clang 7500
#include "quadrant/loop/cascade_p_pi.hpp"
using namespace quadrant;

struct my_axis : cascade_p_pi_boxes<> {
    using cascade_p_pi_boxes<>::cascade_p_pi_boxes;
#ifdef MEND
    proportional<signal::position, signal::velocity> position_loop;
#else
    proportional<signal::position, signal::force> position_loop;
#endif
};
static_assert(axis_boxes<my_axis>);
