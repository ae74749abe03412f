// SPDX-License-Identifier: BSL-1.0
// Two bare numbers for a plant: gain and damping, or numerator and denominator?
// MUST SAY: could not convert | cannot convert | no viable conversion | no matching constructor
// AT MOST: gcc 700, clang 2800
#include "quadrant/base/literals.hpp"
#include "quadrant/observer/disturbance_observer.hpp"
using namespace quadrant::literals;
namespace signal = quadrant::signal;

using observer = quadrant::disturbance_observer<signal::voltage>;
#ifdef MEND
const observer::parameters p{
    .corner = 60_Hz,
    .plant = quadrant::axis_model<signal::voltage>{.gain = 1.9_mps2 / 1_V, .viscous_rate = 4.6_per_s}};
#else
const observer::parameters p{.corner = 60_Hz, .plant = {1.9, 4.6}};
#endif
