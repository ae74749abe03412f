// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/effects.hpp"
#include "../fit/record.hpp"
#include "calibration.hpp"

#include <memory>
#include <optional>

namespace quadrant::diagnosis {

/// A model under trial: the described machine, calibrated, with some effects joined; and how well it predicts
/// motion that it was not fitted to.
struct candidate {
    std::vector<const effect*> effects;
    fit_result fit{};
    std::vector<double> held_out{}; ///< predictive score by motion segment; larger is better
    /// For flexibility: 1/2 ln(blocks) for each parameter that no owner knows, and its choices; and for what is
    /// rare.
    double penalty = 0;
    double total = 0;                     ///< their sum without the penalty
    std::vector<Eigen::VectorXd> leave{}; ///< parameters without each fold, in fit coordinates
    Eigen::MatrixXd curvature{};          ///< of the score, without what the owner knows
    Eigen::MatrixXd gradient{};           ///< of the score, one column a motion segment
    /// rms of the residual force on held-out motion [N], once it was asked for; copies share it.
    std::shared_ptr<std::optional<double>> held_out_force = std::make_shared<std::optional<double>>();
    /// White noise of the position as it sees it [m], likewise.
    std::shared_ptr<std::optional<double>> noise = std::make_shared<std::optional<double>>();
    bool missed = false; ///< the time was up before it was looked at

    /// Whether a number of the machine file, calibrated inside the owner's tolerance, ends at its end.
    bool stops_at_a_tolerance() const {
        for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
            const parameter& p = fit.parameters[i];
            const double x = fit.x[static_cast<Eigen::Index>(i)], low = p.to_fit(p.low),
                         high = p.to_fit(p.high);
            const double hair = 1e-6 * (high - low);
            if (p.spread > 0 && !is_of_record(p) && p.key != "presliding_length_m" &&
                (x <= low + hair || x >= high - hair))
                return true;
        }
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
inline double flexibility(const fit_result& f) {
    const auto free = std::count_if(f.parameters.begin(), f.parameters.end(),
                                    [](const parameter& p) { return !(p.spread > 0); });
    return 0.5 * static_cast<double>(free) *
           std::log(static_cast<double>(std::max<std::size_t>(2, f.ms.empty() ? 0 : f.ms.front().size())));
}

/// What rare effects must bring before they stand beside common ones: their prior odds, as a score.
inline double rarity(const std::vector<const effect*>& effects) {
    double sum = 0;
    for (const effect* e : effects) sum -= score_temperature * std::log(e->prior.odds);
    return sum;
}

} // namespace detail

/// Judges on motion that was not fitted: for each fold the parameters are found again without its segments by
/// one Newton step from the whole fit (the blocks are quadratic there), and the fold is scored with them. Each
/// segment is scored once.
inline void cross_validate(candidate& c, const scoring& s, bool replayed) {
    const auto n = c.fit.x.size();
    std::array<detail::fold_sum, folds> sums;
    detail::fold_sum all{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
    for (auto& f : sums) f = all;
    c.curvature = Eigen::MatrixXd::Zero(n, n);
    c.gradient = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(s.segments));
    Eigen::MatrixXd scratch;
    detail::each_channel(c.fit, s, [&](const auto& blocks, const channel& view) {
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            const double w = view.nu / (blocks.ms[b] + view.floor * view.floor);
            auto& f = sums[fold_of(view.segment_of_block[b])];
            const Eigen::MatrixXd& curvature = blocks.curvature(b, scratch);
            f.a += w * curvature;
            f.g += w * blocks.gradient(b);
            c.curvature += w * curvature;
            c.gradient.col(static_cast<Eigen::Index>(view.segment_of_block[b])) += w * blocks.gradient(b);
        }
    });
    for (const auto& f : sums) {
        all.a += f.a;
        all.g += f.g;
    }
    Eigen::VectorXd low(n), high(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto& p = c.fit.parameters[static_cast<std::size_t>(i)];
        const double x = c.fit.x[i];
        low[i] = std::min(p.to_fit(p.low) - x, 0.0);
        high[i] = std::max(p.to_fit(p.high) - x, 0.0);
        if (!(p.spread > 0)) continue;
        all.a(i, i) += 1 / (p.spread * p.spread);
        all.g[i] += (x - p.expected) / (p.spread * p.spread);
    }
    c.held_out.assign(s.segments, 0.0);
    c.leave.clear();
    std::array<Eigen::VectorXd, folds> step;
    for (std::size_t f = 0; f < folds; ++f) {
        Eigen::MatrixXd a = all.a - sums[f].a;
        a.diagonal() *= 1 + 1e-9;
        if (replayed)
            step[f] = bounded_step(a, all.g - sums[f].g, low, high);
        else // at the optimum, where nothing presses against a bound
            step[f] = solved(a, Eigen::VectorXd(sums[f].g))
                          .unaryExpr([](double d) { return std::isfinite(d) ? d : 0; })
                          .cwiseMax(low)
                          .cwiseMin(high);
        c.leave.push_back(c.fit.x + step[f]);
    }
    detail::each_channel(c.fit, s, [&](const auto& blocks, const channel& view) {
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            const auto segment = view.segment_of_block[b];
            c.held_out[segment] -=
                0.5 * view.nu *
                std::log(blocks.at(b, step[fold_of(segment)], scratch) + view.floor * view.floor);
        }
    });
    c.penalty = detail::flexibility(c.fit) + c.fit.choices + detail::rarity(c.effects);
    c.total = -c.penalty;
    for (double v : c.held_out) c.total += v;
}

/// The parameters of a fitted model, ready to be fitted again from where they are.
inline std::vector<parameter> resumed(const fit_result& f) {
    std::vector<parameter> ps = f.parameters;
    for (std::size_t i = 0; i < ps.size(); ++i) ps[i].start = ps[i].from_fit(f.x[static_cast<Eigen::Index>(i)]);
    return ps;
}

/// A first look at `from` with one more effect: a step or two from every start that the effect offers, the
/// slopes of the parameters that `from` has taken from there; the best kept, less what its parameters cost. No
/// score yet. An effect that offers no start leaves an infinite objective.
class first_look {
public:
    first_look(const fitter& fit, const candidate& from, const effect& added, const screening& look,
               const shared_slopes& slopes, int steps) {
        const auto resumed_from = resumed(from.fit);
        for (const auto& start : added.starts(look)) {
            plant_model plant = from.fit.plant;
            added.join(plant, look);
            std::vector<parameter> ps;
            known_slopes known{.from = &slopes};
            for (std::size_t i = 0; i < resumed_from.size(); ++i) {
                // The effect's own parameters replace the described ones.
                const bool replaced = std::any_of(start.begin(), start.end(), [&](const parameter& q) {
                    return &q.of(plant) == &resumed_from[i].of(plant);
                });
                if (replaced) continue;
                ps.push_back(resumed_from[i]);
                known.which.push_back(i);
            }
            ps.insert(ps.end(), start.begin(), start.end());
            courses_.emplace_back(fit, plant, ps, steps, std::move(known), 0);
        }
    }
    /// One from each start, to be run by the fitter.
    std::vector<fit_course>& courses() { return courses_; }
    /// The best of what they came to.
    fit_result best() {
        fit_result best;
        double least = std::numeric_limits<double>::infinity(); // a start that frees more must earn it
        for (fit_course& c : courses_)
            if (const double cost = c.result().objective + detail::flexibility(c.result()); cost < least) {
                least = cost;
                best = std::move(c.result());
            }
        return best;
    }

private:
    std::vector<fit_course> courses_;
};

/// Scores a fitted model on motion that was not fitted, and keeps of its rows and blocks only what is asked for
/// later: a diagnosis remembers hundreds of models.
inline void judge(const axis_record& record, candidate& c) {
    if (!std::isfinite(c.fit.objective)) return;
    cross_validate(c, record.score, record.replayed());
    c.held_out_force = std::make_shared<std::optional<double>>();
    c.noise = std::make_shared<std::optional<double>>();
    if (const auto& innovation = c.fit.innovation.rows; !innovation.empty())
        *c.noise = position_noise(innovation, record.score, record.resolution);
    c.fit.innovation = {};
    c.fit.quadratic = {};
}

/// Fits sketches to the end, side by side, and scores them.
inline void finish(const axis_record& record, std::span<candidate* const> sketches) {
    const fitter fit(record.observer, record.score);
    std::vector<fit_course> courses;
    std::vector<candidate*> fitted;
    for (candidate* c : sketches) {
        if (!std::isfinite(c->fit.objective)) continue;
        courses.emplace_back(fit, c->fit.plant, resumed(c->fit), 30);
        fitted.push_back(c);
    }
    fit.run(std::span(courses));
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        fitted[i]->fit = std::move(courses[i].result());
        judge(record, *fitted[i]);
    }
}
inline void finish(const axis_record& record, candidate& c) {
    candidate* const one = &c;
    finish(record, std::span(&one, 1));
}

} // namespace quadrant::diagnosis
