// SPDX-License-Identifier: BSL-1.0
// What the tests of the components share: whoever allocates while a real-time function runs is counted, and
// claims are printed. Included once a program: it replaces the allocator.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <new>

static thread_local bool real_time = false;
static int allocations = 0;
void* operator new(std::size_t size) {
    allocations += real_time;
    if (void* p = std::malloc(size)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

static int failures = 0;
static void claim(bool holds, const char* what) {
    std::printf("%s: %s\n", holds ? "ok" : "FAILED", what);
    failures += !holds;
}
