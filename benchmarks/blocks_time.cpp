// SPDX-License-Identifier: BSL-1.0
// Time per sample of every block, moving and standing, and of all else that blocks_count counts.
#include "counted.hpp"

#include <benchmark/benchmark.h>
#include <string>

int main(int argc, char** argv) {
    if (!counted::same_notch() || !counted::same_sums()) return 1;
    counted::all([](const char* name, double amplitude, auto make) {
        const auto row = [&](const std::string& named, bool stands) {
            benchmark::RegisterBenchmark(named.c_str(), [amplitude, make, stands](benchmark::State& state) {
                const auto moving = counted::input(amplitude);
                const auto x = stands ? std::vector<double>(moving.size(), 0.0) : moving;
                const auto step = stands ? counted::rested(make(), moving) : make();
                for (auto _ : state) benchmark::DoNotOptimize(counted::run(step, x, x.size()));
                state.counters["per_sample"] =
                    benchmark::Counter(double(x.size()), benchmark::Counter::kIsIterationInvariantRate |
                                                             benchmark::Counter::kInvert);
            });
        };
        row(std::string("blocks/") + name, false);
        row(std::string("standing/") + name, true);
    });
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
