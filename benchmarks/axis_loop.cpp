// SPDX-License-Identifier: BSL-1.0
// Time per servo period of a closed axis loop: typed blocks beside the same loop written by hand in doubles.
#include "axis_loop.hpp"

#include <benchmark/benchmark.h>

namespace {

template <class Loop> void axis(benchmark::State& state) {
    const std::vector<double> reference = axis_loop::sine();
    for (auto _ : state) {
        Loop loop;
        benchmark::DoNotOptimize(axis_loop::run(loop, reference.data(), reference.size()));
    }
    // Shown as time per sample.
    state.counters["per_sample"] = benchmark::Counter(static_cast<double>(reference.size()),
                                                      benchmark::Counter::kIsIterationInvariantRate |
                                                          benchmark::Counter::kInvert);
}
BENCHMARK(axis<axis_loop::typed_loop>)->Name("axis_loop/typed");
BENCHMARK(axis<axis_loop::hand_loop<true>>)->Name("axis_loop/hand_written");
BENCHMARK(axis<axis_loop::hand_loop<false>>)->Name("axis_loop/hand_written_unchecked");

} // namespace

int main(int argc, char** argv) {
    if (!axis_loop::comparable()) return 1;
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
