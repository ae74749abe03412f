// SPDX-License-Identifier: BSL-1.0
// A memory of velocities sits where the milling axis adds to a position error.
// MUST SAY: decltype (B::memory) | decltype(my_axis::memory)
// MUST SAY: maps<
// MUST SAY: milling_boxes
// AT MOST: gcc 1400, clang 1100
#include "quadrant/loop/milling_axis_boxes.hpp"
#include "quadrant/memory/repetitive.hpp"
using namespace quadrant;

struct my_axis : milling_axis_boxes<> {
    using milling_axis_boxes<>::milling_axis_boxes;
#ifdef MEND
    repetitive<signal::position, 100> memory;
#else
    repetitive<signal::velocity, 100> memory;
#endif
};
static_assert(milling_boxes<my_axis>);
