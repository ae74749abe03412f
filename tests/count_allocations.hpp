// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstddef>
#include <cstdlib>
#include <new>

/// Counts what the whole program allocates: included by one file of it. The functions stand for the standard
/// library's own, which must not be inline.
namespace counted {
inline std::size_t allocations = 0;
} // namespace counted

// Not inlined by the compiler either: GCC warns when it sees only one of a pair.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
    ++counted::allocations;
    if (void* p = std::malloc(bytes != 0 ? bytes : 1)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
