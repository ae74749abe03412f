// SPDX-License-Identifier: BSL-1.0
// A rate [1/s] where a corner [Hz] belongs.
// MUST SAY: could not convert | no viable conversion
// AT MOST: gcc 2300, clang 10200
#include "quadrant/base/literals.hpp"
#include "quadrant/filter/lowpass.hpp"
using namespace quadrant::literals;

using smoother = quadrant::lowpass<quadrant::signal::force>;
#ifdef MEND
const smoother::parameters p{.corner = quadrant::corner_of_rate(60_per_s)};
#else
const smoother::parameters p{.corner = 60_per_s};
#endif
