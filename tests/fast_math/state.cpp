// SPDX-License-Identifier: BSL-1.0
// With QUADRANT_TESTS=all. Compiled with -O3 -ffast-math: reset, settle, copies, zero.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include "../conformance/state.cpp"
