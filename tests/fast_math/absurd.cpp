// SPDX-License-Identifier: BSL-1.0
// With QUADRANT_TESTS=all. Compiled with -O3 -ffast-math, which takes subnormal numbers for zero: a parameter
// that no machine has is refused by name or held.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include "../conformance/absurd.cpp"
