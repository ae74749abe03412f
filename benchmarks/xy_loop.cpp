// SPDX-License-Identifier: BSL-1.0
// Time per servo period of the controller of both axes of the milling table: typed, by hand in doubles with the
// same NaN policy, and as a run-time graph of the same blocks, each with the memory's FIR filters and without;
// and what LinuxCNC's components can do of it, chained as in a HAL thread. Each moving, standing and reversing.
#include "xy_loop.hpp"
#include "hal_chain.hpp"

#include <benchmark/benchmark.h>
#include <optional>
#include <string>

namespace {

template <class Loop> void passes(benchmark::State& state, Loop& both, xy_loop::motion motion) {
    const auto in = xy_loop::inputs(motion);
    if (motion == xy_loop::motion::standing) xy_loop::run(both, in, xy_loop::rest);
    for (auto _ : state) benchmark::DoNotOptimize(xy_loop::run(both, in, in.size()));
    state.counters["per_sample"] = benchmark::Counter(
        double(in.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
template <class Loop> void loop(benchmark::State& state, xy_loop::motion motion) {
    Loop both;
    passes(state, both, motion);
}
/// `add(name, motion)` of a row for each motion.
template <class Add> void each_motion(const std::string& name, Add&& add) {
    add(name, xy_loop::motion::moving);
    add(name + "/standing", xy_loop::motion::standing);
    add(name + "/reversing", xy_loop::motion::reversing);
}
template <class Loop> void rows(const std::string& name) {
    each_motion(name, [](const std::string& row, xy_loop::motion motion) {
        benchmark::RegisterBenchmark(row.c_str(), loop<Loop>, motion);
    });
}
void add_loops() {
    rows<xy_loop::typed<90, 61>>("xy_loop/typed");
    rows<xy_loop::typed_lanes<90, 61>>("xy_loop/typed_lanes");
#ifdef __AVX2__
    rows<xy_loop::by_expert<90, 61>>("xy_loop/expert");
    rows<xy_loop::by_expert<1, 1>>("xy_loop/expert/without_fir");
#endif
    rows<xy_loop::by_hand<90, 61>>("xy_loop/hand_written");
    rows<xy_loop::as_graph<90, 61>>("xy_loop/virtual_graph");
    rows<xy_loop::typed<1, 1>>("xy_loop/typed/without_fir");
    rows<xy_loop::typed_lanes<1, 1>>("xy_loop/typed_lanes/without_fir");
    rows<xy_loop::by_hand<1, 1>>("xy_loop/hand_written/without_fir");
    rows<xy_loop::as_graph<1, 1>>("xy_loop/virtual_graph/without_fir");
}

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
    each_motion("xy_loop/hal_chain", [](const std::string& row, xy_loop::motion motion) {
        benchmark::RegisterBenchmark(row.c_str(), [motion](benchmark::State& state) {
            passes(state, chain, motion);
            state.SetLabel("no friction, observer, memory");
        });
    });
} catch (const std::exception& e) {
    std::fprintf(stderr, "xy_loop/hal_chain: SKIPPED: %s (Debian package linuxcnc-uspace)\n", e.what());
}

} // namespace

int main(int argc, char** argv) {
    if (!xy_loop::comparable<90, 61>() || !xy_loop::comparable<1, 1>()) return 1;
    add_loops();
    add_hal_chain();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
