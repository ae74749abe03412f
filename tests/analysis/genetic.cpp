// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/genetic.hpp>
#include <quadrant/analysis/loop.hpp>
#include <quadrant/analysis/margins.hpp>
#include <quadrant/analysis/move_cost.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
const auto go_on = [](const genetic_state&) { return true; };
const std::vector<gene> box(3, {-5, 5});

/// Rastrigin's function: a valley at 0, and another at nearly every whole number.
double many_valleys(const std::vector<double>& x) {
    double f = 0;
    for (const double each : x) f += 10 + each * each - 10 * std::cos(2 * std::numbers::pi * each);
    return f;
}
/// From the last to the first: as threads might.
struct backwards {
    template <class Work> void operator()(std::size_t n, Work&& work) const {
        for (std::size_t k = n; k-- > 0;) work(k);
    }
};
bool same(const genetic_state& a, const genetic_state& b) {
    return a.population == b.population && a.cost == b.cost && a.generation == b.generation &&
           a.simulations == b.simulations;
}
template <class Make> std::string refused(Make&& make) {
    try {
        make();
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return {};
}
} // namespace

TEST_CASE("genetic: finds the lowest of a thousand valleys, by tournament and by roulette") {
    for (const auto by : {selection::tournament, selection::roulette}) {
        const auto found = tune_genetic(box, many_valleys, 4000, {.by = by}, go_on);
        CHECK(found.best() < 0.5); // the next lowest valley is at 1
        for (const double each : best_of(found, box)) CHECK(std::abs(each) < 0.1);
    }
}
TEST_CASE("genetic: the same seed is the same search in any order of work, another seed is another") {
    const auto one = tune_genetic(box, many_valleys, 600, {.seed = 7}, go_on),
               other = tune_genetic(box, many_valleys, 600, {.seed = 7}, go_on, {}, backwards()),
               third = tune_genetic(box, many_valleys, 600, {.seed = 8}, go_on);
    CHECK(same(one, other));
    CHECK_FALSE(same(one, third));
}
TEST_CASE("genetic: stopped, laid by as text and resumed it ends where it would have ended in one go") {
    const auto whole = tune_genetic(box, many_valleys, 1000, {}, go_on);
    const auto part =
        tune_genetic(box, many_valleys, 1000, {}, [](const genetic_state& s) { return s.generation < 9; });
    CHECK(part.generation == 9);
    CHECK(same(tune_genetic(box, many_valleys, 1000, {}, go_on, read_genetic(written(part))), whole));
}
TEST_CASE("genetic: the best is never lost, no simulation too many, and every generation is told") {
    double last = HUGE_VAL;
    std::uint64_t generations = 0, calls = 0;
    const auto counted = [&](const std::vector<double>& x) { return ++calls, many_valleys(x); };
    const auto found = tune_genetic(box, counted, 1000, {}, [&](const genetic_state& s) {
        CHECK(s.best() <= last);
        CHECK(s.mean() >= s.best());
        last = s.best();
        return s.generation == ++generations;
    });
    CHECK(found.simulations == calls);
    CHECK(calls == 40 + 25 * 38); // 25 further generations of 38 fit into 1000
    CHECK(generations == 26);
}
TEST_CASE("genetic: loops that cannot be simulated die out") {
    const auto half = [](const std::vector<double>& x) {
        return x[0] < 0 ? std::nan("") : x[0] * x[0] + x[1] * x[1];
    };
    const auto found = tune_genetic({{-5, 5}, {1e-3, 10, true}}, half, 2000, {}, go_on);
    CHECK(std::isfinite(found.mean()));
    CHECK(found.best() < 0.01);
    CHECK(std::count_if(found.cost.begin(), found.cost.end(), [](double c) { return std::isfinite(c); }) > 20);
}
TEST_CASE("genetic: without mutation, and blending nothing beyond, all children stay within their parents") {
    const auto first = tune_genetic(box, many_valleys, 40, {}, go_on);
    double low = 1, high = 0;
    for (const auto& one : first.population) low = std::min(low, one[0]), high = std::max(high, one[0]);
    const auto later = tune_genetic(box, many_valleys, 2000, {.blend = 0, .mutation = 0}, go_on, first);
    for (const auto& one : later.population) {
        CHECK(one[0] >= low);
        CHECK(one[0] <= high);
    }
    // No crossover either: only what was there from the start.
    const auto copies = tune_genetic(box, many_valleys, 2000, {.crossover = 0, .mutation = 0}, go_on, first);
    const std::set<std::vector<double>> born(first.population.begin(), first.population.end());
    for (const auto& one : copies.population) CHECK(born.count(one) == 1);
    CHECK(copies.mean() == doctest::Approx(copies.best())); // and of that the best alone
}
TEST_CASE("genetic: tunes the cascade of the thesis from margins and tracking error through one callable") {
    // Gains of Table 2.2 for x; the search may use as much margin as they do.
    const band servo{2_Hz, 900_Hz, 60};
    struct judged {
        double error, gain, phase;
    };
    const auto judge = [&](double kp, double ki, double kv) {
        const analysis::axis_model<> g{28.57 / 1_s, 4.526_mps2 / 1_V, 0.65_ms};
        const p_pi_loop loop{g, pi_model<>{kp * 1_V / 1_mps, ki * 1_V / 1_m},
                             in_series{derivative_model{150_Hz}, notch_model{330_Hz, 0.06}}, kv / 1_s};
        const auto m = margins([&](frequency f) { return loop.open_position(f); }, servo);
        return judged{std::abs(loop.error_ratio(10_Hz)), m.gain() ? m.gain()->value : 0,
                      m.phase() ? m.phase()->value : 0};
    };
    const judged by_hand = judge(60, 450, 150);
    const auto cost = [&](const std::vector<double>& gains) {
        const judged j = judge(gains[0], gains[1], gains[2]);
        return j.error + std::max(0.0, by_hand.gain - j.gain) + std::max(0.0, by_hand.phase - j.phase);
    };
    const std::vector<gene> genes{{10, 200, true}, {10, 5000, true}, {30, 500, true}};
    const auto found = tune_genetic(genes, cost, 1500, {}, go_on);
    const auto gains = best_of(found, genes);
    const judged tuned = judge(gains[0], gains[1], gains[2]);
    CHECK(tuned.gain > by_hand.gain - 0.05);
    CHECK(tuned.phase > by_hand.phase - 0.05);
    CHECK(tuned.error < by_hand.error);
}
TEST_CASE("move_cost: weighted mean squares before and after the end of the move, and of the command") {
    move_cost c({.tracking = 2e-6, .after = 1e-6, .effort = 0.5, .ends = 0.2});
    c.add(0.0, 2e-6, 1), c.add(0.1, -4e-6, 0), c.add(0.2, 3e-6, 0), c.add(0.3, 0, 0);
    CHECK(c.value() == doctest::Approx((1.0 + 4) / 2 + 9.0 / 2 + 4.0 / 4).epsilon(1e-12));
}
TEST_CASE("genetic: refuses ranges, options and texts that are none") {
    const auto with = [](const std::vector<gene>& genes, const genetic_options& o) {
        return refused([&] { tune_genetic(genes, many_valleys, 100, o, go_on); });
    };
    CHECK(with({}, {}) == "tune_genetic.genes = 0: must be one or more");
    CHECK(with({{1, 1}}, {}) == "gene.low = 1: must be finite and below high (1)");
    CHECK(with({{0, 1, true}}, {}) == "gene.low = 0: must be above 0 for a logarithmic gene");
    CHECK(with(box, {.population = 3}) == "genetic_options.population = 3: must be 4 or more");
    CHECK(with(box, {.population = 4, .elite = 4}) ==
          "genetic_options.elite = 4: must be below the population (4)");
    CHECK(with(box, {.mutation = 1.5}) == "genetic_options.mutation = 1.5: must lie between 0 and 1");
    const auto state = tune_genetic(box, many_valleys, 100, {}, go_on);
    CHECK(refused([&] {
              tune_genetic({{0, 1}}, many_valleys, 100, {}, go_on, state);
          }).find("tune_genetic.state = 3: must be of these genes") == 0);
    CHECK(refused([] { read_genetic("12\nno"); }).find("read_genetic.character = 3: must begin a number") == 0);
    CHECK(refused([&] { read_genetic(written(state) + "1\n"); }).find("must be the end") != std::string::npos);
}
