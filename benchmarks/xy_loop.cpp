// SPDX-License-Identifier: BSL-1.0
// Time per servo period of the controller of both axes of the milling table: typed, by hand in doubles with the
// same NaN policy, and as a run-time graph of the same blocks, each with the memory's FIR filters and without;
// and what LinuxCNC's components can do of it, chained as in a HAL thread.
#include "xy_loop.hpp"
#include "hal_chain.hpp"

#include <benchmark/benchmark.h>
#include <optional>

namespace {

template <class Loop>
void passes(benchmark::State& state, Loop& both,
            const std::vector<quadrant_latency::sample>& in = quadrant_latency::circle()) {
    for (auto _ : state) benchmark::DoNotOptimize(xy_loop::run(both, in, in.size()));
    state.counters["per_sample"] = benchmark::Counter(
        double(in.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
template <class Loop> void loop(benchmark::State& state) {
    Loop both;
    passes(state, both);
}
/// Parked: after a rest of 32 000 samples on one place, which must cost no more than moving.
template <class Loop> void standing(benchmark::State& state) {
    Loop both;
    const auto rest = quadrant_latency::standing();
    for (int k = 0; k < 32'000; ++k) both.step(rest[0]);
    passes(state, both, rest);
}
template <class Loop> void reversing(benchmark::State& state) {
    Loop both;
    passes(state, both, quadrant_latency::reversing());
}
BENCHMARK(loop<xy_loop::typed<90, 61>>)->Name("xy_loop/typed");
BENCHMARK(standing<xy_loop::typed<90, 61>>)->Name("xy_loop/typed/standing");
BENCHMARK(reversing<xy_loop::typed<90, 61>>)->Name("xy_loop/typed/reversing");
BENCHMARK(loop<xy_loop::typed_lanes<90, 61>>)->Name("xy_loop/typed_lanes");
BENCHMARK(standing<xy_loop::typed_lanes<90, 61>>)->Name("xy_loop/typed_lanes/standing");
BENCHMARK(reversing<xy_loop::typed_lanes<90, 61>>)->Name("xy_loop/typed_lanes/reversing");
#ifdef __AVX2__
BENCHMARK(loop<xy_loop::by_expert<90, 61>>)->Name("xy_loop/expert");
BENCHMARK(standing<xy_loop::by_expert<90, 61>>)->Name("xy_loop/expert/standing");
BENCHMARK(reversing<xy_loop::by_expert<90, 61>>)->Name("xy_loop/expert/reversing");
#endif
BENCHMARK(loop<xy_loop::by_hand<90, 61>>)->Name("xy_loop/hand_written");
BENCHMARK(standing<xy_loop::by_hand<90, 61>>)->Name("xy_loop/hand_written/standing");
BENCHMARK(reversing<xy_loop::by_hand<90, 61>>)->Name("xy_loop/hand_written/reversing");
BENCHMARK(loop<xy_loop::as_graph<90, 61>>)->Name("xy_loop/virtual_graph");
BENCHMARK(standing<xy_loop::as_graph<90, 61>>)->Name("xy_loop/virtual_graph/standing");
BENCHMARK(loop<xy_loop::typed<1, 1>>)->Name("xy_loop/typed/without_fir");
BENCHMARK(loop<xy_loop::typed_lanes<1, 1>>)->Name("xy_loop/typed_lanes/without_fir");
BENCHMARK(loop<xy_loop::by_hand<1, 1>>)->Name("xy_loop/hand_written/without_fir");
BENCHMARK(loop<xy_loop::as_graph<1, 1>>)->Name("xy_loop/virtual_graph/without_fir");

/// LinuxCNC's own components chained: cascade, notch and inverse of the plant, without friction, observer and
/// memory.
class hal_chain {
public:
    hal_chain() {
        hal::load_for(2);
        x_.emplace(0, gains_of(thesis::x), thread_);
        y_.emplace(1, gains_of(thesis::y), thread_);
    }
    quadrant_latency::commands step(const quadrant_latency::sample& s) noexcept {
        x_->take(s.x.position, s.x.velocity, s.x.acceleration, s.x.measured);
        y_->take(s.y.position, s.y.velocity, s.y.acceleration, s.y.measured);
        thread_.run(500'000);
        return {x_->command(), y_->command()};
    }

private:
    static hal::axis::gains gains_of(const thesis::axis& a) {
        const auto p = xy_loop::in_doubles<1, 1>(a);
        xy_axis<1, 1> d;
        xy_design(&p, &d);
        const double a0 = 1 + d.g * (d.damping + d.g); // its biquad is a direct form
        return {p.position_gain,
                p.velocity_gain,
                p.velocity_integral,
                d.inertia_gain,
                d.drag_gain,
                p.limit,
                1 - d.lose,
                (1 + d.g * d.g) / a0,
                2 * (d.g * d.g - 1) / a0,
                (1 + d.g * d.g) / a0,
                2 * (d.g * d.g - 1) / a0,
                (1 - d.damping * d.g + d.g * d.g) / a0};
    }
    hal::thread thread_;
    std::optional<hal::axis> x_, y_;
};

void add_hal_chain() try {
    static hal_chain chain;
    const quadrant_latency::sample moved{{1e-5, 0, 0, 0}, {1e-5, 0, 0, 0}};
    chain.step(moved); // pid's first call only enables it
    const double u = chain.step(moved).x;
    if (!(u > 0 && u < 10)) throw std::runtime_error("gives no command");
    benchmark::RegisterBenchmark("xy_loop/hal_chain", [](benchmark::State& state) {
        passes(state, chain);
        state.SetLabel("no friction, observer, memory");
    });
} catch (const std::exception& e) {
    std::fprintf(stderr, "xy_loop/hal_chain: SKIPPED: %s (Debian package linuxcnc-uspace)\n", e.what());
}

} // namespace

int main(int argc, char** argv) {
    if (!xy_loop::comparable<90, 61>() || !xy_loop::comparable<1, 1>()) return 1;
    add_hal_chain();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
