// SPDX-License-Identifier: BSL-1.0
// A sum of two wires that carry different things.
// MUST SAY: no match for 'operator+' | invalid operands to binary expression
// AT MOST: gcc 6400, clang 9400
#include "quadrant/base/literals.hpp"
using namespace quadrant::literals;

#ifdef MEND
const auto sum = 3_um + 2_mm;
#else
const auto sum = 3_um + 2_mmps;
#endif
