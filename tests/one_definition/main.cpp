// SPDX-License-Identifier: BSL-1.0
// Every set that this processor has gives the results of the baseline, bit for bit.
#include "run.hpp"

#include <cstdio>
#include <string>

namespace {
std::string words(const result& from) {
    std::array<char, 200> text;
    from.refused.write(text.data(), text.size());
    return text.data();
}
bool agrees(const char* set, const result& it, const result& baseline) {
    for (std::size_t i = 0; i < 8; ++i) {
        if (it.through[i] == baseline.through[i] && it.curved[i] == baseline.curved[i]) continue;
        std::printf("FAILED: %s, lane %zu: %.17g and %.17g, the baseline %.17g and %.17g\n", set, i,
                    it.through[i], it.curved[i], baseline.through[i], baseline.curved[i]);
        return false;
    }
    std::printf("%s: as the baseline\n", set);
    return words(it) == words(baseline);
}
} // namespace

int main() {
    const result baseline = run_baseline();
    std::printf("baseline: %s\n", words(baseline).c_str());
    bool good = words(baseline).starts_with("notch.centre = 4000 Hz");
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        good = agrees("AVX2", run_avx2(), baseline) && good;
    else
        std::puts("SKIPPED: no AVX2 here");
    if (__builtin_cpu_supports("avx512f"))
        good = agrees("AVX-512", run_avx512(), baseline) && good;
    else
        std::puts("SKIPPED: no AVX-512 here");
    return good ? 0 : 1;
}
