// SPDX-License-Identifier: BSL-1.0
// Time per sample of every block, and of all else that blocks_count counts.
#include "counted.hpp"

#include <benchmark/benchmark.h>
#include <string>

int main(int argc, char** argv) {
    if (!counted::same_notch() || !counted::same_sums()) return 1;
    counted::all([](const char* name, double amplitude, auto make) {
        benchmark::RegisterBenchmark((std::string("blocks/") + name).c_str(), [amplitude,
                                                                               make](benchmark::State& state) {
            const auto x = counted::input(amplitude);
            for (auto _ : state) benchmark::DoNotOptimize(counted::run(make(), x, x.size()));
            state.counters["per_sample"] = benchmark::Counter(
                double(x.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
        });
    });
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
