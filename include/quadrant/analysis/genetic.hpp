// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "genetic_child.hpp"
#include "genetic_state.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

namespace detail {
inline void check_genetic(const std::vector<gene>& genes, const genetic_options& o, const genetic_state& s) {
    require(!genes.empty(), "tune_genetic.genes", 0.0, "must be one or more");
    for (const gene& g : genes) {
        require(std::isfinite(g.low) && std::isfinite(g.high) && g.low < g.high, "gene.low", g.low,
                "must be finite and below high (" + quadrant::detail::shortest(g.high) + ")");
        require(!g.logarithmic || g.low > 0, "gene.low", g.low, "must be above 0 for a logarithmic gene");
    }
    require(o.population >= 4, "genetic_options.population", double(o.population), "must be 4 or more");
    require(o.elite < o.population, "genetic_options.elite", double(o.elite),
            "must be below the population (" + quadrant::detail::shortest(double(o.population)) + ")");
    require(o.tournament >= 1, "genetic_options.tournament", double(o.tournament), "must be 1 or more");
    require(o.crossover >= 0 && o.crossover <= 1, "genetic_options.crossover", o.crossover,
            "must lie between 0 and 1");
    require(o.mutation >= 0 && o.mutation <= 1, "genetic_options.mutation", o.mutation,
            "must lie between 0 and 1");
    require_not_negative("genetic_options.blend", o.blend);
    require_positive("genetic_options.width", o.width);
    require(o.trials >= 1, "genetic_options.trials", double(o.trials), "must be 1 or more");
    for (const auto& one : s.population)
        require(one.size() == genes.size() && s.cost.size() == o.population &&
                    s.population.size() == o.population && s.trials.size() == o.population,
                "tune_genetic.state", double(one.size()), "must be of these genes and this population");
}
} // namespace detail

/// Work one after the other; for several threads hand over something like it, such as one that asks a pool.
struct one_by_one {
    template <class Work> void operator()(std::size_t n, Work&& work) const {
        for (std::size_t k = 0; k < n; ++k) work(k);
    }
};

/// Searches genes of least cost(values) by selection, crossover, mutation and elitism of real-coded
/// chromosomes, until so many simulations are spent in all; whole generations only. cost may be any loop's: a
/// double; infinite or NaN when the loop failed. `tell(state)` hears of every generation and ends the search
/// with false.
/// The same seed gives the same search on any number of threads, in one go or resumed: randomness belongs to
/// seed, generation and child. Parents blend, a child lies up to `blend` of their distance beyond them
/// [Eshelman1993]. It has converged when mean() and best() agree.
/// Source: [LowKeck2003]: real-coded, reproduction by fitness, crossover, mutation.
/// A cost that depends on chance, such as that of one machine of many or of an experiment, is a `cost(values,
/// draw)`: the same number `draw` is the same machine. Each generation has draws of its own, or the search
/// tunes to one draw. The least of many costs is mostly a lucky one: what is to live on is tried again until
/// those at the head have had `trials` each, and once more in each generation; its cost is the mean.
/// `each(n, work)` runs work(0) ... work(n - 1), in any order, on any threads; cost is then called from those.
/// Throws for genes without a range, options out of theirs, and a state of another size.
template <class Cost, class Tell, class Each = one_by_one>
genetic_state tune_genetic(const std::vector<gene>& genes, const Cost& cost, std::uint64_t simulations,
                           const genetic_options& o, Tell&& tell, genetic_state s = {}, const Each& each = {}) {
    detail::check_genetic(genes, o, s);
    constexpr bool is_draw = std::is_invocable_v<const Cost&, const std::vector<double>&, std::uint64_t>;
    const auto tried = [&](const std::vector<double>& shares, std::uint64_t draw) {
        std::vector<double> values;
        for (std::size_t i = 0; i < genes.size(); ++i) values.push_back(genes[i].at(shares[i]));
        double c = HUGE_VAL;
        if constexpr (is_draw)
            c = cost(values, draw);
        else
            c = cost(values);
        return std::isfinite(c) ? c : HUGE_VAL;
    };
    for (;;) {
        const std::size_t kept = s.population.empty() ? 0 : o.elite, known = is_draw ? 0 : kept;
        if (s.simulations + o.population - known > simulations) return s;
        genetic_state next;
        next.generation = s.generation + 1, next.simulations = s.simulations + o.population - known;
        next.population.resize(o.population), next.cost.resize(o.population);
        next.trials.resize(o.population, 0);
        for (std::size_t k = 0; k < kept; ++k)
            next.population[k] = s.population[k], next.cost[k] = s.cost[k], next.trials[k] = s.trials[k];
        const auto once_more = [&](std::size_t k, std::uint64_t draw) {
            const double c = tried(next.population[k], draw), sum = next.cost[k] * double(next.trials[k]) + c;
            next.cost[k] = sum / double(++next.trials[k]);
        };
        each(o.population - known, [&](std::size_t n) {
            const std::size_t k = known + n;
            if (k >= kept)
                next.population[k] = detail::child(s, o, genes.size(), {o.seed, s.generation, k - kept});
            once_more(k, s.draws);
        });
        next.draws = s.draws + 1;
        detail::sort(next);
        while (is_draw) {
            std::vector<std::size_t> doubtful;
            for (std::size_t k = 0; k < std::max<std::size_t>(o.elite, 1); ++k)
                if (next.trials[k] < o.trials && std::isfinite(next.cost[k])) doubtful.push_back(k);
            if (doubtful.empty() || next.simulations + doubtful.size() > simulations) break;
            each(doubtful.size(), [&](std::size_t n) { once_more(doubtful[n], next.draws); });
            next.simulations += doubtful.size(), ++next.draws;
            detail::sort(next);
        }
        s = std::move(next);
        if (!tell(static_cast<const genetic_state&>(s))) return s;
    }
}

} // namespace quadrant::inline v0::analysis
