// SPDX-License-Identifier: BSL-1.0
// An integer does not divide by a quantity (Boost.Units keeps to the type of the number): a trap that the docs
// name.
// MUST SAY: no match for 'operator/' | invalid operands to binary expression
// AT MOST: gcc 12600, clang 6700
#include "quadrant/base/literals.hpp"
using namespace quadrant::literals;

#ifdef MEND
const quadrant::per_second gain = 60.0 / 1_s;
#else
const quadrant::per_second gain = 60 / 1_s;
#endif
