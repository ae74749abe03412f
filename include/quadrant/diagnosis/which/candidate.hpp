// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "calibration.hpp"

#include <memory>
#include <optional>
#include <string_view>
#include <utility>

namespace quadrant::inline v0::diagnosis {

/// A model under trial: the described machine, calibrated, with some effects joined; and how well it predicts
/// motion that it was not fitted to.
struct candidate {
    std::vector<const effect*> effects;
    fit_result fit{};
    std::vector<double> held_out{}; ///< predictive score by motion segment; larger is better
    /// For flexibility: 1/2 ln(blocks) for each parameter that no owner knows, and its choices; and for what is
    /// rare.
    double penalty = 0;
    double total = 0;                     ///< sum of `held_out`, less `penalty`
    std::vector<Eigen::VectorXd> leave{}; ///< parameters without each fold, in fit coordinates
    Eigen::MatrixXd curvature{};          ///< of the score, without what the owner knows
    Eigen::MatrixXd gradient{};           ///< of the score, one column a motion segment
    /// Its variance for forces without a name as large as the floor takes them for: what is left below them
    /// scatters less, and moves the score less than they may have moved the numbers. What is left above them is
    /// in the scatter already: there an interval is wider by up to a square root of two.
    Eigen::MatrixXd unknown{};
    /// rms of the residual force on held-out motion [N], once it was asked for; copies share it.
    std::shared_ptr<std::optional<double>> held_out_force = std::make_shared<std::optional<double>>();
    /// What its forces leave along the measured motion [N], likewise.
    std::shared_ptr<std::optional<double>> along_motion = std::make_shared<std::optional<double>>();
    /// White noise of the position as it sees it [m], likewise.
    std::shared_ptr<std::optional<double>> noise = std::make_shared<std::optional<double>>();
    /// How it predicts the hold-out log, likewise.
    struct on_holdout {
        double score = 0;                      ///< log-score
        std::vector<std::vector<double>> ms{}; ///< by channel and block
        double force = 0;                      ///< residual, rms [N]
    };
    std::shared_ptr<std::optional<on_holdout>> holdout = std::make_shared<std::optional<on_holdout>>();
    bool missed = false; ///< the time was up before it was looked at
    /// Of a sketch: what starts that free other numbers came to, where that is near what it is.
    std::vector<fit_result> other_ways{};

    /// Whether a number ends where its search ends.
    bool ends_at_a_bound(std::size_t i) const {
        const parameter& p = fit.parameters[i];
        const double x = fit.x[static_cast<Eigen::Index>(i)], low = p.to_fit(p.low), high = p.to_fit(p.high);
        const double hair = 1e-6 * (high - low);
        return x <= low + hair || x >= high - hair;
    }
    /// Whether one of the numbers with this key does.
    bool ends_at_a_bound(std::string_view key) const {
        for (std::size_t i = 0; i < fit.parameters.size(); ++i)
            if (fit.parameters[i].key == key && ends_at_a_bound(i)) return true;
        return false;
    }
    /// Whether this number of the machine file, calibrated inside the owner's tolerance, ends at its end.
    bool stops_at_its_tolerance(std::size_t i) const {
        const parameter& p = fit.parameters[i];
        return p.spread > 0 && !is_of_record(p) && p.key != "presliding_length_m" && ends_at_a_bound(i);
    }
    /// The same for any of them.
    bool stops_at_a_tolerance() const {
        for (std::size_t i = 0; i < fit.parameters.size(); ++i)
            if (stops_at_its_tolerance(i)) return true;
        return false;
    }
};

inline constexpr std::size_t folds = 5;
inline std::size_t fold_of(std::size_t segment) { return segment % folds; }

namespace detail {

/// Score, gradient and curvature of one fold's blocks.
struct fold_sum {
    Eigen::MatrixXd a;
    Eigen::VectorXd g;
};

template <class Each> void each_channel(const fit_result& f, const scoring& s, Each each) {
    for (std::size_t i = 0; i < f.quadratic.size(); ++i) each(f.quadratic[i], s.channels[i]);
}

/// 1/2 ln(blocks) for each parameter that no owner knows.
QUADRANT_DIAGNOSIS_DECL double flexibility(const fit_result& f);

/// What a start of a first look has come to: a start that frees more must earn it. Less is better.
inline double cost_of(const fit_result& f) { return f.objective + flexibility(f); }

/// What rare effects must bring before they stand beside common ones: their prior odds, as a score.
QUADRANT_DIAGNOSIS_DECL double rarity(const std::vector<const effect*>& effects);

/// Curvature and gradient of the score around a fit: of each fold, and of all.
struct fold_sums {
    std::array<fold_sum, folds> of{};
    fold_sum all{};
    Eigen::VectorXd low{}, high{}; ///< how far each number may still move
};

/// One Newton step from the whole fit to that without a fold, inside the bounds: where a number meets one,
/// those of its valley stop with it.
QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd step_without(const fold_sums& sums, std::size_t fold, bool replayed);

} // namespace detail

/// Judges on motion that was not fitted: for each fold the parameters are found again without its segments by
/// one Newton step from the whole fit (the blocks are quadratic there), and the fold is scored with them. Each
/// segment is scored once.
QUADRANT_DIAGNOSIS_DECL void cross_validate(candidate& c, const scoring& s, bool replayed, bool closed);

/// The parameters of a fitted model, ready to be fitted again from where they are.
QUADRANT_DIAGNOSIS_DECL std::vector<parameter> resumed(const fit_result& f);

/// Scores a fitted model on motion that was not fitted, and keeps of its rows and blocks only what is asked for
/// later: a diagnosis remembers hundreds of models.
QUADRANT_DIAGNOSIS_DECL void judge(const axis_record& record, candidate& c);

/// Fits sketches to the end, side by side, with their other ways, and scores them: the best of each is kept.
QUADRANT_DIAGNOSIS_DECL void finish(const axis_record& record, std::span<candidate* const> sketches);
QUADRANT_DIAGNOSIS_DECL void finish(const axis_record& record, candidate& c);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "candidate.ipp"
#endif
