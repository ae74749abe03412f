// SPDX-License-Identifier: BSL-1.0
// Q falls off slower than the plant: Q/Gn would differentiate the encoder without bound.
// MUST SAY: q_is_not_below_the_relative_degree
// AT MOST: gcc 2600, clang 1200
#include "quadrant/base/literals.hpp"
#include "quadrant/observer/disturbance_observer.hpp"
using namespace quadrant::literals;
namespace signal = quadrant::signal;

#ifdef MEND
using observer = quadrant::disturbance_observer<signal::voltage, signal::position, 3, 1>;
#else
using observer = quadrant::disturbance_observer<signal::voltage, signal::position, 2, 1>;
#endif
const observer box{{60_Hz, quadrant::axis_model<signal::voltage>{4.5_mps2 / 1_V, 28.6 / 1_s}}, 500_us};
