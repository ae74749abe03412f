// SPDX-License-Identifier: BSL-1.0
// A trajectory that gives a velocity where the acceleration belongs feeds a preview.
// MUST SAY: motion_sample
// MUST SAY: acceleration
// AT MOST: gcc 2100, clang 5900
#include "quadrant/feedforward/preview.hpp"
using namespace quadrant;

struct my_motion {
    quantity<si::length> position{};
    quantity<si::velocity> velocity{};
#ifdef MEND
    quantity<si::acceleration> acceleration{};
#else
    quantity<si::velocity> acceleration{};
#endif
};
using ahead = preview<2, my_motion>;
ahead* const axis = nullptr;
