// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "predictor.hpp"
#include "scoring.hpp"

#include <Eigen/Dense>
#include <limits>
#include <string>
#include <vector>

namespace quadrant::diagnosis {

/// One number of the plant model that a fit may move.
struct parameter {
    std::string key;                       ///< the machine file's key
    double& (*of)(plant_model&) = nullptr; ///< where it lives in the model
    double start = 0, low = 0, high = 0;   ///< bounds, in the key's unit
    bool logarithmic = false;              ///< moves by ratio (start, low > 0)
    double step = 1e-4;                    ///< of the finite difference, in fit coordinates
    double expected = 0, spread = 0;       ///< the owner's knowledge, in fit coordinates; spread 0: none

    double to_fit(double natural) const { return logarithmic ? std::log(natural) : natural; }
    double from_fit(double x) const { return logarithmic ? std::exp(x) : x; }
};

/// Mean square of one block as a quadratic in the step of the parameters: ms + 2 g d + d' A d.
struct block_quadratic {
    double ms = 0;
    Eigen::VectorXd g;
    Eigen::MatrixXd a;
    double at(const Eigen::VectorXd& d) const { return std::max(0.0, ms + 2 * g.dot(d) + d.dot(a * d)); }
};

struct fit_result {
    plant_model plant{};
    std::vector<parameter> parameters{};
    Eigen::VectorXd x{}; ///< fit coordinates
    std::vector<double> innovation{};
    std::vector<double> ms{}, ms_mean{}; ///< by block
    double choices = 0;                  ///< score that the model took from the log itself, see predictor::run
    std::vector<block_quadratic> quadratic{}, quadratic_mean{};
    double objective = std::numeric_limits<double>::infinity();
};

/// Fits parameters of the plant by reweighted Gauss-Newton (Levenberg-Marquardt damping, bounds by projection).
class fitter {
public:
    fitter(const predictor& p, const scoring& s) : predictor_(p), scoring_(s) {}

    static void put(plant_model& plant, const std::vector<parameter>& ps, const Eigen::VectorXd& x) {
        for (std::size_t i = 0; i < ps.size(); ++i)
            ps[i].of(plant) = ps[i].from_fit(x[static_cast<Eigen::Index>(i)]);
    }

    double score_ms(const std::vector<double>& ms, const std::vector<double>& ms_mean) const {
        double sum = 0;
        for (double m : ms) sum += 0.5 * scoring_.nu * std::log(m + square(scoring_.floor));
        for (double m : ms_mean) sum += 0.5 * scoring_.nu_mean * std::log(m + square(scoring_.floor_mean));
        return sum;
    }

    /// How the innovation moves with each parameter.
    std::vector<std::vector<double>> slopes(const fit_result& r) const { return slopes(r, {}); }

    /// `known`: slopes that are taken as they are instead of being found again; null where there is none. For a first look
    /// at one more effect: the others' slopes are those of the model without it.
    fit_result fit(const plant_model& start, const std::vector<parameter>& ps, int iterations,
                   const std::vector<const std::vector<double>*>& known = {}) const {
        const auto n = static_cast<Eigen::Index>(ps.size());
        fit_result best{.plant = start, .parameters = ps, .x = Eigen::VectorXd(n)};
        for (Eigen::Index i = 0; i < n; ++i) best.x[i] = p(ps, i).to_fit(p(ps, i).start);
        evaluate(best);
        double damping = 1e-3;
        for (int iteration = 0;; ++iteration) {
            linearize(best, known);
            if (iteration == iterations || n == 0) break;
            bool better = false;
            double gain = 0;
            for (int attempt = 0; attempt < 6 && !better; ++attempt, damping *= 8) {
                fit_result trial{.plant = best.plant, .parameters = ps, .x = step(best, damping)};
                evaluate(trial);
                if (trial.objective < best.objective) {
                    gain = best.objective - trial.objective;
                    best = std::move(trial);
                    better = true;
                    damping = std::max(1e-6, damping / 24);
                }
            }
            if (!better || gain < 0.1) { // a hair beside the margins of the selection
                if (better) linearize(best, known);
                break;
            }
        }
        return best;
    }

    void evaluate(fit_result& r) const {
        put(r.plant, r.parameters, r.x);
        const double choices = predictor_.run(r.plant, r.innovation);
        // As many of a block's rows are independent as its score says.
        r.choices = choices * (scoring_.nu + scoring_.nu_mean) / static_cast<double>(scoring_.block);
        r.ms = detail::block_ms(r.innovation, scoring_.skip, scoring_.block);
        r.ms_mean = detail::block_ms(detail::means(r.innovation, scoring_.skip, scoring_.mean), 0,
                                     scoring_.block / scoring_.mean);
        r.objective = score_ms(r.ms, r.ms_mean) + prior(r) + r.choices;
        if (!std::isfinite(r.objective)) r.objective = std::numeric_limits<double>::infinity();
    }

    double prior(const fit_result& r) const {
        double sum = 0;
        for (Eigen::Index i = 0; i < r.x.size(); ++i)
            if (const auto& q = p(r.parameters, i); q.spread > 0)
                sum += 0.5 * square((r.x[i] - q.expected) / q.spread);
        return sum;
    }

private:
    static double square(double v) { return v * v; }
    static const parameter& p(const std::vector<parameter>& ps, Eigen::Index i) {
        return ps[static_cast<std::size_t>(i)];
    }

    /// Empty where `known` has them.
    std::vector<std::vector<double>> slopes(const fit_result& r,
                                            const std::vector<const std::vector<double>*>& known) const {
        std::vector<plant_model> plants;
        std::vector<std::size_t> which;
        std::vector<double> step;
        for (std::size_t i = 0; i < r.parameters.size(); ++i) {
            if (i < known.size() && known[i]) continue;
            const auto& q = r.parameters[i];
            const double x = r.x[static_cast<Eigen::Index>(i)];
            which.push_back(i);
            step.push_back(x + q.step > q.to_fit(q.high) ? -q.step : q.step);
            plants.push_back(r.plant);
            q.of(plants.back()) = q.from_fit(x + step.back());
        }
        std::vector<std::vector<double>> moved(plants.size()), out(r.parameters.size());
        predictor_.run(plants, moved);
        for (std::size_t j = 0; j < which.size(); ++j) {
            for (std::size_t k = 0; k < moved[j].size(); ++k)
                moved[j][k] = (moved[j][k] - r.innovation[k]) / step[j];
            out[which[j]] = std::move(moved[j]);
        }
        return out;
    }

    void linearize(fit_result& r, const std::vector<const std::vector<double>*>& known) const {
        const auto found = slopes(r, known);
        std::vector<const std::vector<double>*> d;
        std::vector<std::vector<double>> dm;
        for (std::size_t i = 0; i < found.size(); ++i) {
            d.push_back(i < known.size() && known[i] ? known[i] : &found[i]);
            dm.push_back(detail::means(*d.back(), scoring_.skip, scoring_.mean));
        }
        std::vector<const std::vector<double>*> of_means;
        for (const auto& m : dm) of_means.push_back(&m);
        r.quadratic = quadratics(r.innovation, d, scoring_.skip, scoring_.block, r.ms.size());
        r.quadratic_mean = quadratics(detail::means(r.innovation, scoring_.skip, scoring_.mean), of_means, 0,
                                      scoring_.block / scoring_.mean, r.ms_mean.size());
    }

    static std::vector<block_quadratic> quadratics(const std::vector<double>& e,
                                                   const std::vector<const std::vector<double>*>& d,
                                                   std::size_t first, std::size_t block, std::size_t count) {
        const auto n = static_cast<Eigen::Index>(d.size());
        std::vector<block_quadratic> out(count);
        Eigen::MatrixXd j(static_cast<Eigen::Index>(block), n);
        for (std::size_t b = 0; b < count; ++b) {
            const auto k0 = first + b * block;
            for (Eigen::Index i = 0; i < n; ++i)
                for (std::size_t k = 0; k < block; ++k)
                    j(static_cast<Eigen::Index>(k), i) = (*d[static_cast<std::size_t>(i)])[k0 + k];
            const Eigen::Map<const Eigen::VectorXd> eb(e.data() + k0, static_cast<Eigen::Index>(block));
            const double inverse = 1 / static_cast<double>(block);
            out[b] = {.ms = eb.squaredNorm() * inverse,
                      .g = j.transpose() * eb * inverse,
                      .a = j.transpose() * j * inverse};
        }
        return out;
    }

    Eigen::VectorXd step(const fit_result& r, double damping) const {
        const auto n = r.x.size();
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
        add(r.quadratic, scoring_.nu, scoring_.floor, a, g);
        add(r.quadratic_mean, scoring_.nu_mean, scoring_.floor_mean, a, g);
        for (Eigen::Index i = 0; i < n; ++i)
            if (const auto& q = p(r.parameters, i); q.spread > 0) {
                a(i, i) += 1 / square(q.spread);
                g[i] += (r.x[i] - q.expected) / square(q.spread);
            }
        for (Eigen::Index i = 0; i < n; ++i) a(i, i) *= 1 + damping;
        // Projection: what would leave its bounds is set on the bound and the others are solved again.
        std::vector<bool> fixed(static_cast<std::size_t>(n), false);
        Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
        for (Eigen::Index round = 0; round <= n; ++round) {
            std::vector<Eigen::Index> open;
            for (Eigen::Index i = 0; i < n; ++i)
                if (!fixed[static_cast<std::size_t>(i)]) open.push_back(i);
            if (open.empty()) break;
            Eigen::VectorXd rhs = -(g + a * (d - masked(d, open)));
            const Eigen::MatrixXd sub = a(open, open);
            const Eigen::VectorXd solved = sub.ldlt().solve(rhs(open).eval());
            bool clipped = false;
            for (std::size_t j = 0; j < open.size(); ++j) {
                const auto i = open[j];
                const auto& q = p(r.parameters, i);
                const double low = q.to_fit(q.low) - r.x[i], high = q.to_fit(q.high) - r.x[i];
                d[i] = solved[static_cast<Eigen::Index>(j)];
                if (!(d[i] >= low && d[i] <= high)) {
                    d[i] = std::clamp(std::isfinite(d[i]) ? d[i] : 0.0, low, high);
                    fixed[static_cast<std::size_t>(i)] = clipped = true;
                }
            }
            if (!clipped) break;
        }
        return r.x + d;
    }
    static Eigen::VectorXd masked(const Eigen::VectorXd& d, const std::vector<Eigen::Index>& open) {
        Eigen::VectorXd out = Eigen::VectorXd::Zero(d.size());
        for (auto i : open) out[i] = d[i];
        return out;
    }
    static void add(const std::vector<block_quadratic>& blocks, double nu, double floor, Eigen::MatrixXd& a,
                    Eigen::VectorXd& g) {
        for (const auto& b : blocks) {
            const double w = nu / (b.ms + square(floor));
            a += w * b.a;
            g += w * b.g;
        }
    }

    predictor predictor_;
    scoring scoring_;
};

} // namespace quadrant::diagnosis
