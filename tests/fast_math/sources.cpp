// SPDX-License-Identifier: BSL-1.0
// With QUADRANT_TESTS=all. Compiled with -O3 -ffast-math: what holds of every source.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include "../conformance/sources.cpp"
#include "count_allocations.hpp"

std::size_t conformance::allocated() { return counted::allocations; }
