// SPDX-License-Identifier: BSL-1.0
// A notch for forces on a wire that carries a position.
// MUST SAY: notch<quadrant::v0::signal::force | notch<quadrant::signal::force
// AT MOST: gcc 3700, clang 1000
#include "quadrant/base/literals.hpp"
#include "quadrant/filter/notch.hpp"
using namespace quadrant::literals;

auto filtered(quadrant::notch<quadrant::signal::force>& resonance) {
#ifdef MEND
    return resonance(3_N);
#else
    return resonance(3_um);
#endif
}
