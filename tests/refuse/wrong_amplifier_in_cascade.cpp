// SPDX-License-Identifier: BSL-1.0
// Boxes whose amplifier carries another signal than the velocity loop puts out, without a static_assert under
// them.
// MUST SAY: axis_boxes
// MUST SAY: decltype (B::amplifier) | decltype(my_axis::amplifier)
// AT MOST: gcc 1700, clang 1100
#include "quadrant/loop/cascade_p_pi.hpp"
using namespace quadrant;

struct my_axis : cascade_p_pi_boxes<> {
    using cascade_p_pi_boxes<>::cascade_p_pi_boxes;
#ifdef MEND
    limiter<signal::voltage> amplifier;
#else
    limiter<signal::force> amplifier;
#endif
};

using loop = cascade<my_axis>;
loop* const axis = nullptr;
