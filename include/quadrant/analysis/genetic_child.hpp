// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "genetic_state.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

/// How one generation of a genetic search becomes the next one.
namespace quadrant::inline v0::analysis::detail {

/// Numbers of one child in one generation: the same whoever computes it, and when.
class child_random {
public:
    child_random(std::uint64_t seed, std::uint64_t generation, std::uint64_t child)
        : at_(mixed(mixed(mixed(seed) + generation) + child)) {}
    double uniform() { return double(mixed(at_++) >> 11) * 0x1p-53; } ///< 0 ... 1, without 1
    double normal() {
        const double u = 1 - uniform();
        return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * uniform());
    }
    std::size_t below(std::size_t n) { return std::min(n - 1, std::size_t(uniform() * double(n))); }

private:
    static std::uint64_t mixed(std::uint64_t n) { // splitmix64 [Steele2014]
        n = (n + 1) * 0x9e3779b97f4a7c15u;
        n = (n ^ (n >> 30)) * 0xbf58476d1ce4e5b9u;
        n = (n ^ (n >> 27)) * 0x94d049bb133111ebu;
        return n ^ (n >> 31);
    }
    std::uint64_t at_;
};

inline const std::vector<double>& parent(const genetic_state& s, const genetic_options& o,
                                         child_random& random) {
    const std::size_t n = s.population.size();
    if (o.by == selection::tournament) { // sorted: the best has the lowest number
        std::size_t best = random.below(n);
        for (std::size_t k = 1; k < o.tournament; ++k) best = std::min(best, random.below(n));
        return s.population[best];
    }
    double worst = s.cost.front(), all = 0;
    for (const double c : s.cost)
        if (std::isfinite(c)) worst = std::max(worst, c);
    const auto share = [&](double c) { return std::isfinite(c) ? worst - c : 0; };
    for (const double c : s.cost) all += share(c);
    if (!(all > 0)) return s.population[random.below(n)]; // all alike
    double left = random.uniform() * all;
    for (std::size_t k = 0; k < n; ++k)
        if ((left -= share(s.cost[k])) < 0) return s.population[k];
    return s.population.front();
}

inline std::vector<double> child(const genetic_state& s, const genetic_options& o, std::size_t genes,
                                 child_random random) {
    std::vector<double> out(genes);
    if (s.population.empty()) {
        for (double& each : out) each = random.uniform();
        return out;
    }
    const auto& mother = parent(s, o, random);
    const auto& father = random.uniform() < o.crossover ? parent(s, o, random) : mother;
    for (std::size_t i = 0; i < genes; ++i) {
        const double where = (1 + 2 * o.blend) * random.uniform() - o.blend;
        double x = mother[i] + where * (father[i] - mother[i]);
        if (random.uniform() < o.mutation) x += o.width * random.normal();
        out[i] = std::clamp(x, 0.0, 1.0);
    }
    return out;
}

/// Least cost first; of equal costs the earlier.
inline void sort(genetic_state& s) {
    std::vector<std::size_t> order(s.cost.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return s.cost[a] < s.cost[b]; });
    genetic_state sorted = s;
    for (std::size_t k = 0; k < order.size(); ++k) {
        sorted.population[k] = std::move(s.population[order[k]]);
        sorted.cost[k] = s.cost[order[k]], sorted.trials[k] = s.trials[order[k]];
    }
    s = std::move(sorted);
}

} // namespace quadrant::inline v0::analysis::detail
