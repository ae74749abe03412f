// SPDX-License-Identifier: BSL-1.0
// Time per servo period of the interpolator, moves handed over as they are needed: all that a controller spends
// on its path.
#include <benchmark/benchmark.h>
#include <quadrant/base/literals.hpp>
#include <quadrant/trajectory/interpolator.hpp>

#include <cmath>
#include <vector>

namespace {

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::path;
using namespace quadrant::trajectory;

move at_feed(const segment& path, double feed) {
    move m{path};
    m.feed = feed;
    m.ending = path_ending::continuous;
    m.tolerance = 1e-5;
    return m;
}
/// A bent path of so many straight moves.
std::vector<move> lines(std::size_t count, double length, double feed) {
    std::vector<move> moves;
    point at;
    for (std::size_t k = 0; k < count; ++k) {
        const double angle = 0.8 * std::sin(0.03 * double(k));
        const point to = at + length * point{std::cos(angle), std::sin(angle), 0};
        moves.push_back(at_feed(line(at, to), feed));
        at = to;
    }
    return moves;
}
std::vector<move> circles() { return {at_feed(arc({0.05, 0, 0}, {}, 100), 0.2)}; }
std::vector<move> splines() {
    std::vector<move> moves;
    for (int k = 0; k < 500; ++k)
        moves.push_back(at_feed(spline::quintic({{0.01 * k, 0, 0}, {0.8, k % 2 ? -0.6 : 0.6, 0}, {}},
                                                {{0.01 * (k + 1), 0, 0}, {0.8, k % 2 ? 0.6 : -0.6, 0}, {}}),
                                0.1));
    return moves;
}

void driven(benchmark::State& state, const std::vector<move>& moves) {
    const auto limit = [](double v, double a, double j) {
        return motion_limits{v * 1_mps, a * 1_mps2, jerk::from_value(j)};
    };
    const motion_limits axis = limit(0.5, 5, 200);
    std::size_t periods = 0;
    for (auto _ : state) {
        interpolator<> drive({.limits = {{axis, axis, axis}, limit(0.5, 2, 50)}}, 1_ms);
        std::size_t next = 0;
        for (periods = 0; next < moves.size() || !drive.done(); ++periods) {
            while (!drive.full() && next < moves.size()) drive.push(moves[next++]);
            benchmark::DoNotOptimize(drive());
        }
    }
    state.counters["periods"] = double(periods);
    state.counters["per_period"] = benchmark::Counter(
        double(periods), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["per_move"] = benchmark::Counter(
        double(moves.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(driven, circles, circles());
BENCHMARK_CAPTURE(driven, splines, splines());
BENCHMARK_CAPTURE(driven, lines_of_5_mm, lines(2000, 5e-3, 0.2));
BENCHMARK_CAPTURE(driven, lines_of_500_um, lines(20000, 5e-4, 0.05));
BENCHMARK_CAPTURE(driven, lines_of_100_um, lines(20000, 1e-4, 0.05));

} // namespace

BENCHMARK_MAIN();
