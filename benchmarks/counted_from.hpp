// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstddef>
#include <utility>

#if __has_include(<valgrind/callgrind.h>)
#    include <valgrind/callgrind.h>
#else // callgrind then counts two runs of different lengths (callgrind.sh)
#    define CALLGRIND_START_INSTRUMENTATION
#    define CALLGRIND_STOP_INSTRUMENTATION
#endif

/// Runs samples 0 to n in one or two pieces: run(first, last). Under `valgrind --tool=callgrind
/// --instr-atstart=no` only those behind `from` are counted; 0: nothing is told to valgrind.
template <class Run> double counted_from(std::size_t from, std::size_t n, Run&& run) {
    double sum = 0;
    for (const auto& [first, last] : {std::pair{std::size_t{0}, from}, std::pair{from, n}}) { // one call of run
        if (first == last) continue;
        if (first > 0) {
            CALLGRIND_START_INSTRUMENTATION;
        }
        sum += run(first, last);
    }
    if (from > 0) {
        CALLGRIND_STOP_INSTRUMENTATION;
    }
    return sum;
}
