// SPDX-License-Identifier: BSL-1.0
// A field of another spelling, in a named constant: the message names the field.
// MUST SAY: no non-static data member named 'center' | field designator 'center' does not refer to any
// AT MOST: gcc 350, clang 700
#include "quadrant/base/literals.hpp"
#include "quadrant/filter/notch.hpp"
using namespace quadrant::literals;

using force_notch = quadrant::notch<quadrant::signal::force>;
#ifdef MEND
const force_notch::parameters resonance{.centre = 330_Hz};
#else
const force_notch::parameters resonance{.center = 330_Hz};
#endif
