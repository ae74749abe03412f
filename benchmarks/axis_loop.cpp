// SPDX-License-Identifier: BSL-1.0
// Time per servo period of a closed axis loop: typed blocks beside the same loop written by hand in doubles,
// moving, standing and reversing.
#include "axis_loop.hpp"

#include <benchmark/benchmark.h>
#include <string>

namespace {

/// Each pass over `reference` from sample `from` on, with a loop that has gone up to there before.
template <class Loop>
void axis(benchmark::State& state, const std::vector<double>& reference, std::size_t from) {
    const std::size_t n = reference.size() - from;
    Loop before;
    axis_loop::run(before, reference.data(), from);
    for (auto _ : state) {
        Loop loop = before;
        benchmark::DoNotOptimize(axis_loop::run(loop, reference.data() + from, n));
    }
    // Shown as time per sample.
    state.counters["per_sample"] = benchmark::Counter(
        static_cast<double>(n), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
template <class Loop> void rows(const std::string& name) {
    benchmark::RegisterBenchmark(name.c_str(), axis<Loop>, axis_loop::sine(), std::size_t(0));
    benchmark::RegisterBenchmark((name + "/standing").c_str(), axis<Loop>, axis_loop::standing(),
                                 axis_loop::rested);
    benchmark::RegisterBenchmark((name + "/reversing").c_str(), axis<Loop>, axis_loop::reversing(),
                                 std::size_t(0));
}

} // namespace

int main(int argc, char** argv) {
    if (!axis_loop::comparable()) return 1;
    rows<axis_loop::typed_loop>("axis_loop/typed");
    rows<axis_loop::hand_loop<true>>("axis_loop/hand_written");
    rows<axis_loop::hand_loop<false>>("axis_loop/hand_written_unchecked");
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
