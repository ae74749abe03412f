// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "stage_moves.hpp"

#include <quadrant/analysis/genetic.hpp>
#include <quadrant/analysis/move_cost.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>
#ifdef QUADRANT_NLOPT
#    include <nlopt.hpp>
#endif

namespace quadrant_reproduce {

/// What is tuned: weights of the law (only their ratios matter, so the increment stands), drift of the filter,
/// and how much of the believed dry friction is fed forward.
inline const std::vector<quadrant::analysis::gene> stage_genes{
    {1e-6, 100e-6, true}, {0.3e-3, 30e-3, true}, {3, 300, true}, {0.3, 1.7}};

/// The source's fitness (9) as a cost: 500 um in 0.2 s, and 0.1 s at the target. Weights ours: 2 um on the way
/// or after it and 2 A cost the same. Where the counts of the encoder lie makes it rough: so would a machine.
inline double stage_cost(const std::vector<double>& genes, double heavier = 0) {
    stage::machine is = stage::real, thought = stage::believed;
    is.mass *= 1 + heavier;
    is.substeps = 8; // 0.25 ms
    thought.coulomb *= genes[3], thought.static_level *= genes[3];
    const stage::tuning t{genes[0], genes[1], 0.02, genes[2]};
    quadrant::analysis::move_cost cost({.tracking = 2e-6, .after = 2e-6, .effort = 2, .ends = 0.2});
    try {
        stage::move<stage::fed_forward>(is, thought, t, 500e-6, 0.2, 0.3, [&](const stage::moment& m) {
            cost.add(m.time, m.error(), m.command);
        });
    } catch (const quadrant::invalid_parameter&) { // the law refuses weights whose loop is not stable
        return HUGE_VAL;
    }
    return cost.value();
}
/// Mean cost on machines spread over +-1 % of the mass, `first` the number of the first: where the counts of
/// their encoders happen to lie is chance.
inline double stage_cost_on(int first, int machines, const std::vector<double>& genes) {
    double sum = 0;
    for (int k = first; k < first + machines; ++k) {
        const double golden = 0.6180339887498949 * (k + 1);
        sum += stage_cost(genes, 0.02 * (golden - std::floor(golden) - 0.5));
    }
    return sum / machines;
}
/// What each search may spend, and what judges it: machines that no search has seen.
inline constexpr int stage_simulations = 3750;
inline double stage_judged(const std::vector<double>& genes) { return stage_cost_on(100'000, 100, genes); }

/// A search that keeps its machines tunes to their counts: fifteen of them, so that a trial says something.
inline constexpr int stage_kept = 15, stage_kept_trials = stage_simulations / stage_kept;
inline double stage_cost_on_kept(const std::vector<double>& genes) {
    return stage_cost_on(0, stage_kept, genes);
}
/// The genetic algorithm has others in each generation, and few will do: what lives on has met more.
inline constexpr int stage_drawn = 5;
inline double stage_cost_on_drawn(const std::vector<double>& genes, std::uint64_t draw) {
    return stage_cost_on(1000 + int(draw) * stage_drawn, stage_drawn, genes);
}

/// Each search is made so often, with other random numbers.
inline constexpr std::array<std::uint64_t, 2> stage_seeds{1, 2};
inline const char* const stage_tuning_title = "Tuning: the best so far";
inline picture stage_tuning_picture(line best) {
    return {stage_tuning_title,
            "Lower is better; each has so many simulations of the move.",
            {panel{.x_label = "simulations",
                   .y_label = "cost",
                   .lines = {std::move(best)},
                   .log_x = true,
                   .log_y = true}}};
}
inline row stage_tuning_row(const std::string& id, const std::string& what, double cost,
                            const std::string& note) {
    return {id, what, "", cost, {}, {}, {}, note};
}
/// What one search found, with the least cost so far after so many simulations.
struct stage_found {
    std::vector<double> genes{};
    double lowest = HUGE_VAL;
    line best{.name = "", .x = {}, .y = {}};
};
/// Rows and picture of a search that was made with each seed.
template <class Search>
outcome stage_searches(const std::string& id, const std::string& name, const Search& search) {
    outcome out;
    double mean = 0, worst = 0;
    for (const std::uint64_t seed : stage_seeds) {
        stage_found found = search(seed);
        const double unseen = stage_judged(found.genes);
        out.rows.push_back(stage_tuning_row(id, "fitness_seed_" + std::to_string(seed), found.lowest,
                                            "on the machines searched on"));
        out.rows.push_back(stage_tuning_row(id, "fitness_on_unseen_seed_" + std::to_string(seed), unseen, ""));
        mean += unseen / double(stage_seeds.size()), worst = std::max(worst, unseen);
        if (seed != stage_seeds.front()) continue;
        found.best.name = name;
        out.pictures = {stage_tuning_picture(std::move(found.best))};
    }
    out.rows.push_back(stage_tuning_row(id, "fitness_on_unseen", mean,
                                        "mean of both, on 100 machines that were not searched on"));
    out.rows.push_back(stage_tuning_row(id, "fitness_on_unseen_worst", worst, ""));
    return out;
}

inline stage_found stage_tuning_genetic(std::uint64_t seed) {
    stage_found out;
    quadrant::analysis::genetic_options how;
    how.seed = seed;
    how.population = 20;
    const auto last =
        quadrant::analysis::tune_genetic(stage_genes, stage_cost_on_drawn, stage_simulations / stage_drawn, how,
                                         [&](const quadrant::analysis::genetic_state& s) {
                                             out.best.x.push_back(double(s.simulations) * stage_drawn);
                                             out.best.y.push_back(s.best());
                                             return true;
                                         });
    out.genes = quadrant::analysis::best_of(last, stage_genes);
    out.lowest = last.best();
    return out;
}

/// Trials at random places.
inline stage_found stage_tuning_random(std::uint64_t seed) {
    stage_found out;
    quadrant::analysis::detail::child_random random(seed, 0, 0);
    for (int trial = 0; trial < stage_kept_trials; ++trial) {
        std::vector<double> genes;
        for (const auto& gene : stage_genes) genes.push_back(gene.at(random.uniform()));
        const double cost = stage_cost_on_kept(genes);
        if (cost < out.lowest) out.lowest = cost, out.genes = genes;
        out.best.x.push_back((trial + 1.0) * stage_kept), out.best.y.push_back(out.lowest);
    }
    return out;
}

#ifdef QUADRANT_NLOPT
/// Trials of NLopt's controlled random search.
inline stage_found stage_tuning_nlopt(std::uint64_t seed) {
    stage_found out;
    nlopt::srand(seed);
    nlopt::opt method(nlopt::GN_CRS2_LM, unsigned(stage_genes.size()));
    method.set_lower_bounds(0.0);
    method.set_upper_bounds(1.0);
    method.set_maxeval(stage_kept_trials);
    method.set_min_objective(
        [](const std::vector<double>& share, std::vector<double>&, void* data) {
            std::vector<double> genes;
            for (std::size_t i = 0; i < share.size(); ++i) genes.push_back(stage_genes[i].at(share[i]));
            auto& found = *static_cast<stage_found*>(data);
            const double cost = std::min(stage_cost_on_kept(genes), 1e9); // NLopt wants numbers
            if (cost < found.lowest) found.lowest = cost, found.genes = genes;
            found.best.x.push_back(double(found.best.x.size() + 1) * stage_kept);
            found.best.y.push_back(found.lowest);
            return cost;
        },
        &out);
    std::vector<double> share(stage_genes.size(), 0.5);
    double least = 0;
    method.optimize(share, least);
    return out;
}
#endif

inline experiment stage_tuning() {
    const std::string ga = "stage.tuning.ga", chance = "stage.tuning.random";
    experiment e{"Tuning the precision stage",
                 stage_source,
                 "Four genes (weight of position and of speed, drift of the Kalman filter, share of the "
                 "believed friction) tuned on the source's fitness, twice by each method with 3750 simulations "
                 "of the move; machines differ by up to 1 % of the mass, and each result is evaluated on 100 "
                 "others. Where the counts of an encoder lie is chance, and a search that keeps its machines "
                 "tunes to it: trials at random places and NLopt's controlled random search (GN_CRS2_LM) have "
                 "fifteen machines a trial, always the same. Our genetic algorithm has five others in each "
                 "generation, and what lives on keeps the mean of all that it has met. The source gives no "
                 "figures, and what its weights are is not printed.",
                 0.02,
                 {{ga, [=] { return stage_searches(ga, "genetic", stage_tuning_genetic); }},
                  {chance, [=] { return stage_searches(chance, "at random", stage_tuning_random); }}}};
#ifdef QUADRANT_NLOPT
    const std::string crs = "stage.tuning.reference";
    e.cases.push_back({crs, [=] { return stage_searches(crs, "CRS2-LM of NLopt", stage_tuning_nlopt); }});
#endif
    return e;
}

} // namespace quadrant_reproduce
