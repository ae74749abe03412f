// SPDX-License-Identifier: BSL-1.0
// 25 Hz where a gain [1/s] belongs: its number would make a loop 2 pi slower than meant.
// MUST SAY: could not convert | no viable conversion
// MUST SAY: frequency_dimension
// AT MOST: gcc 1700, clang 9500
#include "quadrant/base/literals.hpp"
#include "quadrant/control/proportional.hpp"
using namespace quadrant::literals;
namespace signal = quadrant::signal;

using position_loop = quadrant::proportional<signal::position, signal::velocity>;
#ifdef MEND
const position_loop::parameters p{.gain = quadrant::rate_of_corner(25_Hz)};
#else
const position_loop::parameters p{.gain = 25_Hz};
#endif
