// SPDX-License-Identifier: BSL-1.0
// Loaded before the C library (LD_PRELOAD): of the allocations from the beginning of main() on, number
// QUADRANT_FAIL_AT fails, once. With QUADRANT_COUNT_TO their number is written into that file when the program
// ends. What it starts (gnuplot) has all memory. Constants that allocate are made before main(): without memory
// for them a program has read and written nothing.
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
}

namespace {
using main_function = int (*)(int, char**, char**);
std::atomic<bool> began{false};
std::atomic<long> taken{0};
long fails_at = 0; // 0: none
main_function program = nullptr;

bool refused() noexcept {
    if (!began || ++taken != fails_at) return false;
    errno = ENOMEM;
    return true;
}

int counted_main(int argc, char** argv, char** environment) {
    if (const char* at = std::getenv("QUADRANT_FAIL_AT")) fails_at = std::atol(at);
    unsetenv("LD_PRELOAD");
    began = true;
    return program(argc, argv, environment);
}

__attribute__((destructor)) void end() {
    began = false;
    const char* to = std::getenv("QUADRANT_COUNT_TO");
    std::FILE* file = to ? std::fopen(to, "w") : nullptr;
    if (!file) return;
    std::fprintf(file, "%ld\n", taken.load());
    std::fclose(file);
}
} // namespace

extern "C" {
void* malloc(std::size_t size) { return refused() ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t n, std::size_t size) { return refused() ? nullptr : __libc_calloc(n, size); }
void* realloc(void* p, std::size_t size) { return refused() ? nullptr : __libc_realloc(p, size); }

int __libc_start_main(main_function main, int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
    using start = int (*)(main_function, int, char**, void (*)(), void (*)(), void (*)(), void*);
    program = main;
    const auto next = reinterpret_cast<start>(dlsym(RTLD_NEXT, "__libc_start_main"));
    return next(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}
}
