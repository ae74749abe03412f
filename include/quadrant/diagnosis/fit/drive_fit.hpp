// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "bounded_step.hpp"
#include "drive_starts.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Fits plants with their drive's loops closed on them to the path of one record.
class drive_fit : public drive_starts {
public:
    using drive_starts::drive_starts;

protected:
    struct candidate {
        plant_model plant{};
        std::vector<parameter> parameters{};
        Eigen::VectorXd x{};
        std::vector<double> residual{};
        double ms = 1; ///< of the residual [m^2]
        double objective = std::numeric_limits<double>::infinity();
    };

    void judge(candidate& c) const {
        c.ms = rms(c.residual) * rms(c.residual);
        c.objective = 0.5 * static_cast<double>(rows_) * std::log(c.ms + 0.01 * noise_ * noise_);
        for (Eigen::Index i = 0; i < c.x.size(); ++i) {
            const parameter& q = c.parameters[static_cast<std::size_t>(i)];
            if (q.spread > 0) c.objective += 0.5 * (c.x[i] / q.spread) * (c.x[i] / q.spread);
        }
        if (!std::isfinite(c.objective)) c.objective = std::numeric_limits<double>::infinity();
    }
    void look_at(candidate& c) const {
        fitter::put(c.plant, c.parameters, c.x);
        c.residual = run({&c.plant, 1})[0];
        judge(c);
    }
    /// Slopes of the residual; its own plant runs beside those that are moved, on the same clock.
    Eigen::MatrixXd slopes(const candidate& c) const {
        const auto n = static_cast<Eigen::Index>(c.residual.size());
        Eigen::MatrixXd out(n, c.x.size());
        constexpr auto moved = static_cast<Eigen::Index>(predictor::in_a_group) - 1;
        for (Eigen::Index i = 0; i < c.x.size(); i += moved) {
            std::vector<plant_model> plants{c.plant};
            std::vector<double> step;
            const Eigen::Index end = std::min(i + moved, c.x.size());
            for (Eigen::Index j = i; j < end; ++j) {
                const parameter& p = c.parameters[static_cast<std::size_t>(j)];
                Eigen::VectorXd x = c.x;
                step.push_back(x[j] + p.step > p.to_fit(p.high) ? -p.step : p.step);
                x[j] += step.back();
                plants.push_back(c.plant);
                fitter::put(plants.back(), c.parameters, x);
            }
            const auto e = run(plants);
            for (Eigen::Index j = i; j < end; ++j) {
                const auto at = static_cast<std::size_t>(j - i);
                for (Eigen::Index k = 0; k < n; ++k)
                    out(k, j) =
                        (e[at + 1][static_cast<std::size_t>(k)] - e[0][static_cast<std::size_t>(k)]) / step[at];
            }
        }
        return out;
    }
    double weight(const candidate& c) const { return 1 / (c.ms + 0.01 * noise_ * noise_); }
    static void add_prior(const candidate& c, Eigen::MatrixXd& a, Eigen::VectorXd& g) {
        for (Eigen::Index i = 0; i < c.x.size(); ++i) {
            const parameter& q = c.parameters[static_cast<std::size_t>(i)];
            if (!(q.spread > 0)) continue;
            a(i, i) += 1 / (q.spread * q.spread);
            g[i] += c.x[i] / (q.spread * q.spread);
        }
    }
    void improve(candidate& c, int iterations) const {
        const auto p = c.x.size();
        Eigen::VectorXd low(p), high(p);
        for (Eigen::Index i = 0; i < p; ++i) {
            const parameter& q = c.parameters[static_cast<std::size_t>(i)];
            low[i] = q.to_fit(q.low);
            high[i] = q.to_fit(q.high);
        }
        double damping = 1e-3;
        for (int i = 0; i < iterations && damping < 1e6; ++i) {
            const Eigen::MatrixXd j = slopes(c);
            const double w = weight(c);
            const Eigen::VectorXd e = Eigen::Map<const Eigen::VectorXd>(
                c.residual.data(), static_cast<Eigen::Index>(c.residual.size()));
            Eigen::MatrixXd a = w * j.transpose() * j;
            Eigen::VectorXd g = w * j.transpose() * e;
            add_prior(c, a, g);
            a.diagonal() = a.diagonal().cwiseMax(1e-12);
            const double before = c.objective;
            while (damping < 1e6) {
                Eigen::MatrixXd damped = a;
                damped.diagonal() *= 1 + damping;
                candidate next = c;
                next.x += bounded_step(damped, g, low - c.x, high - c.x);
                look_at(next);
                if (next.objective < c.objective) {
                    c = std::move(next);
                    damping *= 0.1;
                    break;
                }
                damping *= 10;
            }
            if (before - c.objective < 1e-3) return; // nats
        }
    }
    candidate fitted(std::vector<plant_model> plants) const {
        std::vector<candidate> all;
        std::sort(plants.begin(), plants.end(), [&](const plant_model& a, const plant_model& b) {
            return steps_of_drive(a, period_) < steps_of_drive(b, period_);
        });
        auto e = run(plants);
        for (std::size_t i = 0; i < plants.size(); ++i) {
            candidate c;
            c.plant = plants[i];
            c.parameters = parameters_at(c.plant);
            c.x.resize(static_cast<Eigen::Index>(c.parameters.size()));
            for (std::size_t j = 0; j < c.parameters.size(); ++j)
                c.x[static_cast<Eigen::Index>(j)] = c.parameters[j].to_fit(c.parameters[j].start);
            c.residual = std::move(e[i]);
            judge(c);
            all.push_back(std::move(c));
        }
        std::sort(all.begin(), all.end(),
                  [](const candidate& a, const candidate& b) { return a.objective < b.objective; });
        constexpr std::size_t followed = 3;
        if (all.size() > followed) all.resize(followed);
        for (candidate& c : all) improve(c, 8);
        candidate best = *std::min_element(all.begin(), all.end(), [](const candidate& a, const candidate& b) {
            return a.objective < b.objective;
        });
        improve(best, 40);
        return best;
    }
};

} // namespace quadrant::inline v0::diagnosis::detail
