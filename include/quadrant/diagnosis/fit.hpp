// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "predictor.hpp"
#include "scoring.hpp"

#include <Eigen/Dense>
#include <limits>
#include <string>
#include <vector>

namespace quadrant::diagnosis {

/// Solves a x = b for a symmetric, positive a. Its rows have different units: each is taken in its own size, so that no pivot
/// depends on them.
template <class Right> Right solved(const Eigen::MatrixXd& a, const Right& b) {
    const Eigen::VectorXd size =
        a.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1.0; });
    const Eigen::MatrixXd even = size.asDiagonal() * a * size.asDiagonal();
    return size.asDiagonal() * even.ldlt().solve(size.asDiagonal() * b);
}

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

/// A plant model fitted to one record, and how well it predicts each block of it.
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
    /// `chords`: steps that may be taken with the slopes of an earlier point before they are found again. Slopes cost a pass
    /// for each parameter, a step costs one; the last steps are taken with new slopes in any case.
    fit_result fit(const plant_model& start, const std::vector<parameter>& ps, int iterations,
                   const std::vector<const std::vector<double>*>& known = {}, int chords = 4) const {
        const auto n = static_cast<Eigen::Index>(ps.size());
        fit_result best{.plant = start, .parameters = ps, .x = Eigen::VectorXd(n)};
        for (Eigen::Index i = 0; i < n; ++i) best.x[i] = p(ps, i).to_fit(p(ps, i).start);
        evaluate(best);
        double damping = 1e-3, since = 0; // what was gained with these slopes
        int old = 0;
        std::vector<std::vector<double>> d = slopes(best, known);
        linearize(best, d, known);
        for (int iteration = 0; iteration < iterations && n > 0; ++iteration) {
            bool better = false;
            double gain = 0;
            const double damping_before = damping;
            for (int attempt = 0; attempt < 6 && !better; ++attempt, damping *= 8) {
                fit_result trial{.plant = best.plant, .parameters = ps, .x = step(best, damping)};
                evaluate(trial);
                if (trial.objective < best.objective) {
                    gain = best.objective - trial.objective;
                    trial.quadratic = std::move(best.quadratic);
                    trial.quadratic_mean = std::move(best.quadratic_mean);
                    best = std::move(trial);
                    better = true;
                    damping = std::max(1e-6, damping / 24);
                }
            }
            since += gain;
            const bool settled = gain < 0.1; // a hair beside the margins of the selection
            if ((settled && since < 1) || iteration + 1 == iterations) {
                if (better) follow(best, d, known);
                break;
            }
            if (settled || ++old > chords) {
                d = slopes(best, known);
                linearize(best, d, known);
                since = 0;
                old = 0;
                if (!better) damping = damping_before;
            } else {
                follow(best, d, known);
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

    using columns = std::vector<const std::vector<double>*>;
    static columns pointers(const std::vector<std::vector<double>>& d, const columns& known = {}) {
        columns out;
        for (std::size_t i = 0; i < d.size(); ++i)
            out.push_back(i < known.size() && known[i] ? known[i] : &d[i]);
        return out;
    }
    std::vector<std::vector<double>> means_of(const columns& d) const {
        std::vector<std::vector<double>> out;
        for (const auto* x : d) out.push_back(detail::means(*x, scoring_.skip, scoring_.mean));
        return out;
    }
    /// The blocks as quadratics, with these slopes.
    void linearize(fit_result& r, const std::vector<std::vector<double>>& found, const columns& known) const {
        r.quadratic.assign(r.ms.size(), {});
        r.quadratic_mean.assign(r.ms_mean.size(), {});
        quadratics(r, found, known, true);
    }
    /// The same at another point with the slopes kept.
    void follow(fit_result& r, const std::vector<std::vector<double>>& found, const columns& known) const {
        quadratics(r, found, known, false);
    }
    void quadratics(fit_result& r, const std::vector<std::vector<double>>& found, const columns& known,
                    bool curvature) const {
        const auto d = pointers(found, known);
        const auto dm = means_of(d);
        quadratics(r.quadratic, r.innovation, d, scoring_.skip, scoring_.block, curvature);
        quadratics(r.quadratic_mean, detail::means(r.innovation, scoring_.skip, scoring_.mean), pointers(dm), 0,
                   scoring_.block / scoring_.mean, curvature);
    }
    static void quadratics(std::vector<block_quadratic>& out, const std::vector<double>& e, const columns& d,
                           std::size_t first, std::size_t block, bool curvature) {
        const auto n = static_cast<Eigen::Index>(d.size());
        Eigen::MatrixXd j(static_cast<Eigen::Index>(block), n);
        for (std::size_t b = 0; b < out.size(); ++b) {
            const auto k0 = first + b * block;
            for (Eigen::Index i = 0; i < n; ++i)
                std::copy_n(d[static_cast<std::size_t>(i)]->data() + k0, block, j.col(i).data());
            const Eigen::Map<const Eigen::VectorXd> eb(e.data() + k0, static_cast<Eigen::Index>(block));
            const double inverse = 1 / static_cast<double>(block);
            out[b].ms = eb.squaredNorm() * inverse;
            out[b].g = j.transpose() * eb * inverse;
            if (curvature) out[b].a = j.transpose() * j * inverse;
        }
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
            const Eigen::VectorXd free = solved(sub, Eigen::VectorXd(rhs(open)));
            bool clipped = false;
            for (std::size_t j = 0; j < open.size(); ++j) {
                const auto i = open[j];
                const auto& q = p(r.parameters, i);
                const double low = q.to_fit(q.low) - r.x[i], high = q.to_fit(q.high) - r.x[i];
                d[i] = free[static_cast<Eigen::Index>(j)];
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
