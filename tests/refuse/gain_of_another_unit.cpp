// SPDX-License-Identifier: BSL-1.0
// The gain of a position loop where the gain of a velocity loop belongs.
// MUST SAY: could not convert | no viable conversion
// AT MOST: gcc 1900, clang 11100
#include "quadrant/base/literals.hpp"
#include "quadrant/control/proportional.hpp"
using namespace quadrant::literals;
namespace signal = quadrant::signal;

using velocity_loop = quadrant::proportional<signal::velocity, signal::force>;
#ifdef MEND
const velocity_loop::parameters p{.gain = 2000_N / 1_mps};
#else
const velocity_loop::parameters p{.gain = 60.0 / 1_s};
#endif
