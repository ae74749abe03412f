// SPDX-License-Identifier: BSL-1.0
// Time of the diagnosis' parts against the length of the log: reading, one pass of the plant, one fit, the
// whole.
//   build/bench/benchmarks/diagnosis
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/fit/predictor.hpp>
#include <quadrant/diagnosis/model/plant_model.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <benchmark/benchmark.h>
#include <cmath>
#include <cstdlib>

namespace {
using namespace quadrant::diagnosis;

const std::filesystem::path data = std::filesystem::path(QUADRANT_SOURCE_DIR) / "examples/data";

/// The shipped log, its first rows.
machine_log rows(std::size_t n) {
    machine_log log = read_log(data / "log.csv");
    for (auto& a : log.axes)
        for (auto* column : {&a.reference, &a.position, &a.command})
            column->resize(std::min(n, column->size()));
    log.samples = std::min(n, log.samples);
    return log;
}

void read(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(read_log(data / "log.csv").samples);
}

void one_pass(benchmark::State& state) {
    const auto log = rows(static_cast<std::size_t>(state.range(0)));
    const auto machine = read_machine(data / "machine.json");
    const predictor p{.period = machine.sample_period_s,
                      .corner_Hz = 60,
                      .position = log.axes[0].position,
                      .command = log.axes[0].command};
    const plant_model plant(machine.axes[0].plant, 2e-7);
    std::vector<double> e;
    for (auto _ : state) {
        p.run(plant, e);
        benchmark::DoNotOptimize(e.data());
    }
    state.SetComplexityN(state.range(0));
}

void whole(benchmark::State& state, rules r) {
    r.threads = 1;
    const auto log = rows(static_cast<std::size_t>(state.range(0)));
    const auto machine = read_machine(data / "machine.json");
    for (auto _ : state)
        benchmark::DoNotOptimize(diagnose(
                                     machine, log, nullptr, [](const std::string&) {}, r)
                                     .causes.size());
    state.SetComplexityN(state.range(0));
}

} // namespace

BENCHMARK(read)->Unit(benchmark::kMillisecond);
BENCHMARK(one_pass)
    ->RangeMultiplier(2)
    ->Range(7000, 28000)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity(benchmark::oN);
BENCHMARK_CAPTURE(whole, in_full, rules{})
    ->RangeMultiplier(2)
    ->Range(7000, 28000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);
BENCHMARK_CAPTURE(whole, fast, fast_rules())
    ->RangeMultiplier(2)
    ->Range(7000, 28000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);
BENCHMARK_MAIN();
