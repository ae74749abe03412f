// SPDX-License-Identifier: BSL-1.0
// Time of one row of one plant in the observer's pass over a log, alone and in lanes, by the instruction set
// that this file is compiled for. The counter a_lane_sample is that time.
//   build/bench/benchmarks/plant_pass_avx2
#include <quadrant/diagnosis/fit/pass.hpp>
#include <quadrant/diagnosis/model/plant_model.hpp>

#include <benchmark/benchmark.h>
#include <cmath>
#include <numbers>

namespace {
using namespace quadrant::diagnosis;

constexpr std::size_t rows = 28000;
constexpr double period = 5e-4;

/// An axis of 320 kg with Stribeck friction whose delay splits each period.
plant_model stribeck() {
    plant_model model;
    model.mass = 320;
    model.force_constant = 1450;
    model.delay = 4e-4;
    model.friction.viscous_slope = 1750;
    model.friction.coulomb = 122;
    model.friction.excess = 55;
    model.friction.stribeck_velocity = 0.0022;
    model.friction.contact.length = 2e-7;
    return model;
}

/// Without a delay each row is one step instead of two.
plant_model undelayed() {
    plant_model model = stribeck();
    model.delay = 0;
    return model;
}

/// And with four harmonics of cogging.
plant_model cogging() {
    plant_model model = stribeck();
    model.cogging.count = 4;
    model.cogging.period = 0.03;
    model.cogging.cosine[0] = 3;
    model.cogging.sine[3] = 1;
    return model;
}

/// `stands`: all rows at one position, without a command.
void plant_pass(benchmark::State& state, std::size_t plants, const plant_model& model, bool stands = false) {
    std::vector<double> position(rows, 0.01), command(rows);
    for (std::size_t k = 0; k < rows && !stands; ++k) {
        const double t = period * static_cast<double>(k);
        position[k] = std::round(0.03 * std::sin(4.4 * t) / 2.5e-7) * 2.5e-7;
        command[k] = 0.14 * (std::cos(4.4 * t) > 0 ? 1 : -1) - 0.13 * std::sin(4.4 * t);
    }
    std::vector<plant_model> models(plants, model);
    std::vector<pass_input::plant> each;
    for (std::size_t i = 0; i < plants; ++i) {
        models[i].mass *= 1 + 0.001 * static_cast<double>(i);
        each.push_back({axis_parameters(models[i]), models[i].delay});
    }
    std::vector<std::vector<double>> e(plants, std::vector<double>(rows));
    std::vector<double*> innovation;
    for (auto& one : e) innovation.push_back(one.data());
    const double pole = std::exp(-2 * std::numbers::pi * 60 * period); // both of the observer, at 60 Hz
    const pass_input in{.period = period,
                        .rows = rows,
                        .position = position.data(),
                        .command = command.data(),
                        .to_position = 1 - pole * pole,
                        .to_velocity = (1 - pole) * (1 - pole) / period,
                        .plants = plants,
                        .plant_of = each.data(),
                        .innovation = innovation.data()};
    for (auto _ : state) {
        pass_all(in, passes_of<>);
        benchmark::DoNotOptimize(e.data());
        benchmark::ClobberMemory();
    }
    state.counters["a_lane_sample"] =
        benchmark::Counter(static_cast<double>(rows * plants),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

} // namespace

BENCHMARK_CAPTURE(plant_pass, scalar, 1, stribeck())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plant_pass, lanes, 16, stribeck())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plant_pass, scalar_standing, 1, stribeck(), true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plant_pass, lanes_standing, 16, stribeck(), true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plant_pass, scalar_undelayed, 1, undelayed())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plant_pass, lanes_undelayed, 16, undelayed())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plant_pass, scalar_cogging, 1, cogging())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plant_pass, lanes_cogging, 16, cogging())->Unit(benchmark::kMicrosecond);
BENCHMARK_MAIN();
