// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <system_error>
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
