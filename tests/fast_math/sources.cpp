// SPDX-License-Identifier: BSL-1.0
// With QUADRANT_TESTS=all. Compiled with -O3 -ffast-math: what holds of every source.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include "../conformance/sources.cpp"

#include <cstdlib>
#include <new>

namespace {
std::size_t allocations = 0;
}
[[gnu::noinline]] void* operator new(std::size_t bytes) {
    ++allocations;
    if (void* p = std::malloc(bytes != 0 ? bytes : 1)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
std::size_t conformance::allocated() { return allocations; }
