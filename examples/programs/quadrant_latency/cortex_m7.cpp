// SPDX-License-Identifier: BSL-1.0
// Runs the directed calls on a Cortex-M7 under QEMU and prints the instructions of each kind in a row, with
// bars between: name, calls, median, most. Built by cortex_m7.sh; `quadrant-latency --bound` starts it.
#include "directed.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace {

/// QEMU with -icount shift=8: an instruction is 256 ns, and SysTick counts down every 40 ns, 24 bits.
volatile std::uint32_t* const systick = reinterpret_cast<std::uint32_t*>(0xE000E010); // control, reload, value
void start_clock() {
    systick[1] = 0xFFFFFF;
    systick[2] = 0;
    systick[0] = 5;
}
std::size_t instructions_since(std::uint32_t begin) {
    const std::uint32_t ticks = (begin - systick[2]) & 0xFFFFFF;
    return (std::size_t(ticks) * 40 + 128) / 256;
}
template <class Call, class Input> [[gnu::noinline]] auto called(Call& call, const Input& input) {
    return call(input);
}
template <class Call, class Input> std::size_t counted(Call& call, const Input& input) {
    const std::uint32_t begin = systick[2];
    const auto out = called(call, input);
    const std::size_t spent = instructions_since(begin);
    asm volatile("" : : "g"(&out) : "memory");
    return spent;
}

} // namespace

int main() {
    using namespace quadrant_latency;
    start_clock();
    const auto nothing = [](const sample& s) { return commands{s.x.position, s.y.position}; };
    const std::size_t call_alone = counted(nothing, sample{});
    std::array<std::vector<std::size_t>, kinds.size()> counts;
    directed_calls<typed_loop<memory>>([&](std::size_t number, auto& call, const auto& input) {
        counts[number].push_back(counted(call, input) - call_alone);
    });
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        auto& sorted = counts[i];
        std::sort(sorted.begin(), sorted.end());
        std::printf("%s|%u|%u|%u\n", kinds[i].name, unsigned(sorted.size()),
                    unsigned(sorted[sorted.size() / 2]), unsigned(sorted.back()));
    }
    return 0;
}
