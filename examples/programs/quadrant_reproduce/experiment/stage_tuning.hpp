// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "stage_moves.hpp"

#include <quadrant/analysis/genetic.hpp>
#include <quadrant/analysis/move_cost.hpp>

#include <array>
#include <cmath>
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
/// The machines that are searched on, by how much heavier each is, spread evenly over +-1 %: of one alone a
/// search learns where the counts of its encoder happen to lie.
inline constexpr std::array stage_searched{0.0, -0.0076, 0.0047, -0.0029, 0.0094};
inline double stage_searched_cost(const std::vector<double>& genes) {
    double sum = 0;
    for (const double heavier : stage_searched)
        sum += stage_cost(genes, heavier) / double(stage_searched.size());
    return sum;
}
/// What is left of it on machines that the search did not see: the mean of nine whose mass differs by 0.1 %.
inline double stage_judged(const std::vector<double>& genes) {
    double sum = 0;
    for (int k = 1; k <= 9; ++k) sum += stage_cost(genes, 1e-3 * k);
    return sum / 9;
}

/// In simulations: five of them are one trial.
inline constexpr std::array stage_budgets{1000, 4000, 8000};
inline constexpr int stage_trials(int budget) { return budget / int(stage_searched.size()); }
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
inline std::string fitness_after(int budget) { return "fitness_" + std::to_string(budget); }
inline row stage_judged_row(const std::string& id, const std::vector<double>& genes) {
    return stage_tuning_row(id, "fitness_on_nine_others", stage_judged(genes),
                            "the last one, on machines not searched on");
}

inline outcome stage_tuning_genetic(const std::string& id) {
    line best{.name = "genetic", .x = {}, .y = {}};
    outcome out;
    std::size_t next = 0;
    const auto found =
        quadrant::analysis::tune_genetic(stage_genes, stage_searched_cost, stage_trials(stage_budgets.back()),
                                         {}, [&](const quadrant::analysis::genetic_state& s) {
                                             best.x.push_back(double(s.simulations * stage_searched.size())),
                                                 best.y.push_back(s.best());
                                             return true;
                                         });
    for (const int budget : stage_budgets) {
        while (next + 1 < best.x.size() && best.x[next + 1] <= budget) ++next;
        out.rows.push_back(stage_tuning_row(id, fitness_after(budget), best.y[next], ""));
    }
    out.rows.push_back(stage_judged_row(id, quadrant::analysis::best_of(found, stage_genes)));
    out.pictures = {stage_tuning_picture(std::move(best))};
    return out;
}

#ifdef QUADRANT_NLOPT
inline outcome stage_tuning_nlopt(const std::string& id, nlopt::algorithm how, const std::string& name) {
    struct search {
        std::vector<double> best;
        double lowest = HUGE_VAL;
        std::vector<double> genes{};
    } found;
    nlopt::srand(1);
    nlopt::opt method(how, unsigned(stage_genes.size()));
    method.set_lower_bounds(0.0);
    method.set_upper_bounds(1.0);
    method.set_maxeval(stage_trials(stage_budgets.back()));
    method.set_min_objective(
        [](const std::vector<double>& share, std::vector<double>&, void* data) {
            std::vector<double> genes;
            for (std::size_t i = 0; i < share.size(); ++i) genes.push_back(stage_genes[i].at(share[i]));
            auto& s = *static_cast<search*>(data);
            const double cost = std::min(stage_searched_cost(genes), 1e9); // NLopt wants numbers
            if (cost < s.lowest) s.lowest = cost, s.genes = genes;
            s.best.push_back(s.lowest);
            return cost;
        },
        &found);
    std::vector<double> share(stage_genes.size(), 0.5);
    double least = 0;
    method.optimize(share, least);
    outcome out;
    line best{.name = name, .x = {}, .y = {}};
    for (std::size_t k = 39; k < found.best.size(); k += 40)
        best.x.push_back(double((k + 1) * stage_searched.size())), best.y.push_back(found.best[k]);
    for (const int budget : stage_budgets)
        out.rows.push_back(
            stage_tuning_row(id, fitness_after(budget),
                             found.best[std::min(std::size_t(stage_trials(budget)), found.best.size()) - 1],
                             std::size_t(stage_trials(budget)) > found.best.size()
                                 ? "stopped by itself after " + std::to_string(found.best.size())
                                 : ""));
    out.rows.push_back(stage_judged_row(id, found.genes));
    out.pictures = {stage_tuning_picture(std::move(best))};
    return out;
}
#endif

inline experiment stage_tuning() {
    experiment e{
        "Tuning the precision stage",
        stage_source,
        "Four genes (weight of position and of speed, drift of the Kalman filter, share of the believed "
        "friction) "
        "tuned on the source's fitness by our genetic algorithm and by NLopt's controlled random search "
        "(GN_CRS2_LM), with as many simulations each, on five machines whose mass differs by up to 1 %: "
        "on one alone a search learns where the counts of its encoder lie. Judged on nine others. The source "
        "gives no "
        "figures, and what its weights are is not printed.",
        0.02,
        {{"stage.tuning.ga", [] { return stage_tuning_genetic("stage.tuning.ga"); }}}};
#ifdef QUADRANT_NLOPT
    e.cases.push_back(
        {"stage.tuning.reference",
         [] { return stage_tuning_nlopt("stage.tuning.reference", nlopt::GN_CRS2_LM, "CRS2-LM of NLopt"); }});
#endif
    return e;
}

} // namespace quadrant_reproduce
