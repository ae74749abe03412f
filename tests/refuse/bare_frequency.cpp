// SPDX-License-Identifier: BSL-1.0
// A frequency without its unit: hertz or rad/s?
// MUST SAY: could not convert '3.3e+2' from 'double' | no viable conversion from 'double'
// AT MOST: gcc 1200, clang 4000
#include "quadrant/base/literals.hpp"
#include "quadrant/filter/notch.hpp"
using namespace quadrant::literals;

using force_notch = quadrant::notch<quadrant::signal::force>;
#ifdef MEND
const force_notch::parameters resonance{.centre = 330_Hz};
#else
const force_notch::parameters resonance{.centre = 330.0};
#endif
