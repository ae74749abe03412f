// SPDX-License-Identifier: BSL-1.0
// A log column said to be newtons, on a wire that carries a position.
// MUST SAY: tap
// MUST SAY: same_as
// AT MOST: gcc 9400, clang 7300
#include "quadrant/block/taps.hpp"
using namespace quadrant;

struct wires {
    quantity_of<signal::position> error;
};
#ifdef MEND
constexpr auto column = tap<signal::position, &wires::error>("error");
#else
constexpr auto column = tap<signal::force, &wires::error>("error");
#endif
