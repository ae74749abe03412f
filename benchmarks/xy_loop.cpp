// SPDX-License-Identifier: BSL-1.0
// Time per servo period of the controller of both axes of the milling table: typed, by hand in doubles with the
// same NaN policy, and as a run-time graph of the same blocks, each with the memory's FIR filters and without;
// and what LinuxCNC's components can do of it, chained as in a HAL thread. Each moving, standing and reversing.
// usage: xy_loop [options of Google Benchmark]    one row after the other
//        xy_loop turns ROUNDS        all but LinuxCNC's in turns, a tenth of the motion each time, and lines
//            NAME|ns a sample, the shortest|that in times of the expert's|median of these ratios, round by round
#include "xy_loop.hpp"
#include "hal_chain.hpp"

#include <algorithm>
#include <array>
#include <benchmark/benchmark.h>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <time.h>
#include <utility>
#include <vector>

namespace {

/// A row that takes turns with the others: its loop lives on from one turn to the next.
struct row_in_turns {
    std::string name;
    xy_loop::motion motion;
    std::function<double(const std::vector<xy_loop::sample>&)> pass;
    std::vector<double> ns{}; ///< of a sample, one of each round
};
std::vector<row_in_turns>& rows_in_turns() {
    static std::vector<row_in_turns> all;
    return all;
}

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
        rows_in_turns().push_back({row, motion, [both = std::make_shared<Loop>()](const auto& in) {
                                       return xy_loop::run(*both, in, in.size());
                                   }});
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

double cpu_ns() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * double(t.tv_sec) + double(t.tv_nsec);
}
/// A tenth of a motion; the first samples bring the loop into the cache and are not measured.
struct turn {
    std::vector<xy_loop::sample> warm, measured;
};
std::vector<turn> turns_of(xy_loop::motion motion) {
    constexpr std::size_t parts = 10, warm = 100;
    const auto all = xy_loop::inputs(motion);
    const auto begin = all.begin() + (motion == xy_loop::motion::standing ? std::ptrdiff_t(xy_loop::rest) : 0);
    const std::ptrdiff_t n = (all.end() - begin) / std::ptrdiff_t(parts);
    std::vector<turn> each;
    for (auto at = begin; all.end() - at >= n; at += n)
        each.push_back({{at, at + std::ptrdiff_t(warm)}, {at + std::ptrdiff_t(warm), at + n}});
    return each;
}
double shortest(const row_in_turns& row) { return *std::min_element(row.ns.begin(), row.ns.end()); }
/// The expert's row of the same motion and memory, or null.
const row_in_turns* expert_of(const std::string& name) {
    const auto kind = name.find('/') + 1, rest = std::min(name.find('/', kind), name.size());
    const std::string expert = "xy_loop/expert" + name.substr(rest);
    for (const row_in_turns& each : rows_in_turns())
        if (each.name == expert) return &each;
    return nullptr;
}
/// The rows that belong together stand beside each other, and every other round goes backwards: what slows the
/// computer down for a while meets all of them.
int in_turns(std::size_t rounds) {
    auto& rows = rows_in_turns();
    const auto place = [](const row_in_turns& row) {
        return std::pair(row.name.find("without_fir") != std::string::npos, row.motion);
    };
    std::stable_sort(rows.begin(), rows.end(),
                     [&](const auto& a, const auto& b) { return place(a) < place(b); });
    const std::array parts{turns_of(xy_loop::motion::moving), turns_of(xy_loop::motion::standing),
                           turns_of(xy_loop::motion::reversing)};
    const auto rested = xy_loop::inputs(xy_loop::motion::standing);
    for (row_in_turns& row : rows)
        if (row.motion == xy_loop::motion::standing) benchmark::DoNotOptimize(row.pass(rested));
    for (std::size_t round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < rows.size(); ++i) {
            row_in_turns& row = rows[round % 2 == 0 ? i : rows.size() - 1 - i];
            const auto& of = parts[std::size_t(row.motion)];
            const turn& now = of[round % of.size()];
            benchmark::DoNotOptimize(row.pass(now.warm));
            const double begin = cpu_ns();
            benchmark::DoNotOptimize(row.pass(now.measured));
            row.ns.push_back((cpu_ns() - begin) / double(now.measured.size()));
        }
    for (const row_in_turns& row : rows) {
        std::printf("%s|%.*f|", row.name.c_str(), shortest(row) < 100 ? 1 : 0, shortest(row));
        if (const row_in_turns* const expert = expert_of(row.name)) {
            std::vector<double> ratios;
            for (std::size_t k = 0; k < rounds; ++k) ratios.push_back(row.ns[k] / expert->ns[k]);
            std::sort(ratios.begin(), ratios.end());
            const double middle = (ratios[(rounds - 1) / 2] + ratios[rounds / 2]) / 2;
            std::printf("%.2f|%.2f\n", shortest(row) / shortest(*expert), middle);
        } else
            std::printf("|\n");
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    if (!xy_loop::comparable<90, 61>() || !xy_loop::comparable<1, 1>()) return 1;
    add_loops();
    add_hal_chain();
    if (argc == 3 && std::string_view(argv[1]) == "turns") {
        const std::size_t rounds = std::strtoul(argv[2], nullptr, 10);
        return rounds > 0 ? in_turns(rounds) : 2;
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
}
