// SPDX-License-Identifier: BSL-1.0
// Gain and integral gain exchanged: they differ by a second, so the compiler can distinguish them.
// MUST SAY: could not convert | no viable conversion
// AT MOST: gcc 700, clang 14100
#include "quadrant/base/literals.hpp"
#include "quadrant/control/proportional_integral.hpp"
using namespace quadrant::literals;
namespace signal = quadrant::signal;

const auto gain = 60_V / 1_mps;
const auto integral_gain = 450_V / 1_m;
#ifdef MEND
const quadrant::proportional_integral<signal::velocity, signal::voltage>::parameters p{
    .gain = gain, .integral_gain = integral_gain, .limit = 10_V};
#else
const quadrant::proportional_integral<signal::velocity, signal::voltage>::parameters p{
    .gain = integral_gain, .integral_gain = gain, .limit = 10_V};
#endif
