// SPDX-License-Identifier: BSL-1.0
// Long: one search: its operators, its state and how the state is kept.
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Where a gain may lie; over decades in its logarithm.
struct gene {
    double low, high;
    bool logarithmic = false; ///< then low > 0

    double at(double share) const { ///< share 0 ... 1 of the way from low to high
        return logarithmic ? low * std::pow(high / low, share) : low + share * (high - low);
    }
};

enum class selection {
    tournament, ///< the best of so many drawn
    roulette    ///< drawn in proportion to how far its cost lies below the worst
};

/// How a generation becomes the next one; the same seed gives the same search.
struct genetic_options {
    std::size_t population = 40; ///< 4 or more
    std::size_t elite = 2;       ///< that live on unchanged; below population
    selection by = selection::tournament;
    std::size_t tournament = 3; ///< 1 or more
    double crossover = 0.9;     ///< share of children of two parents; 0 ... 1
    double blend = 0.5;         ///< how far beyond its parents a child may lie, of their distance; >= 0
    double mutation = 0.2;      ///< chance of each gene; 0 ... 1
    double width = 0.1;         ///< standard deviation of a mutation, of the gene's range; > 0
    std::uint64_t trials = 4;   ///< where the cost is a draw: before one may live on; 1 or more
    std::uint64_t seed = 1;
};

/// All that a search knows: run on from it, or from what read_genetic makes of its text.
struct genetic_state {
    std::vector<std::vector<double>> population; ///< shares 0 ... 1, least cost first
    std::vector<double> cost;                    ///< of each, the mean of its trials; infinite: it failed
    std::vector<std::uint64_t> trials;           ///< of each; one, unless the cost is a draw
    std::uint64_t generation = 0, simulations = 0, draws = 0;

    double best() const { return cost.front(); }
    double mean() const { ///< of those that could be simulated
        double sum = 0, count = 0;
        for (const double each : cost)
            if (std::isfinite(each)) sum += each, ++count;
        return sum / count;
    }
};

/// The genes' values of the best.
inline std::vector<double> best_of(const genetic_state& s, const std::vector<gene>& genes) {
    std::vector<double> out;
    for (std::size_t i = 0; i < genes.size(); ++i) out.push_back(genes[i].at(s.population.front()[i]));
    return out;
}

namespace detail {
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

/// To lay a search by: one number after the other, all digits.
inline std::string written(const genetic_state& s) {
    std::string out;
    const auto add = [&](auto number) {
        char text[32];
        out.append(text, std::to_chars(text, text + sizeof text, number).ptr).append(1, '\n');
    };
    add(s.generation), add(s.simulations), add(s.draws), add(std::uint64_t(s.population.size()));
    add(std::uint64_t(s.population.empty() ? 0 : s.population.front().size()));
    for (std::size_t k = 0; k < s.population.size(); ++k) {
        add(s.cost[k]), add(s.trials[k]);
        for (const double x : s.population[k]) add(x);
    }
    return out;
}
/// Throws when the text is none of `written`.
inline genetic_state read_genetic(const std::string& text) {
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto next = [&](auto& number) {
        const auto found = std::from_chars(at, end, number);
        require(found.ec == std::errc() && found.ptr != end && *found.ptr == '\n', "read_genetic.character",
                double(at - text.data()), "must begin a number on a line of its own");
        at = found.ptr + 1;
    };
    genetic_state s;
    std::uint64_t people = 0, genes = 0;
    next(s.generation), next(s.simulations), next(s.draws), next(people), next(genes);
    require(people <= text.size() && genes <= text.size(), "read_genetic.population", double(people),
            "must be no more than there are numbers (" + quadrant::detail::shortest(double(text.size())) + ")");
    for (std::uint64_t k = 0; k < people; ++k) {
        s.cost.emplace_back(), s.trials.emplace_back();
        next(s.cost.back()), next(s.trials.back());
        s.population.emplace_back();
        for (std::uint64_t i = 0; i < genes; ++i)
            s.population.back().emplace_back(), next(s.population.back().back());
    }
    require(at == end, "read_genetic.character", double(at - text.data()), "must be the end");
    return s;
}

} // namespace quadrant::inline v0::analysis
