// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL void fitter::put(plant_model& plant, const std::vector<parameter>& ps,
                                         const Eigen::VectorXd& x) {
    for (std::size_t i = 0; i < ps.size(); ++i)
        ps[i].of(plant) = ps[i].from_fit(x[static_cast<Eigen::Index>(i)]);
}

QUADRANT_DIAGNOSIS_DECL double fitter::score_ms(const std::vector<std::vector<double>>& ms) const {
    double sum = 0;
    for (std::size_t i = 0; i < ms.size(); ++i) {
        const channel& c = scoring_.channels[i];
        for (std::size_t b = 0; b < ms[i].size(); ++b) sum += 0.5 * c.nu * std::log(ms[i][b] + c.least(b));
    }
    return sum;
}

QUADRANT_DIAGNOSIS_DECL shared_slopes fitter::slopes(fit_result& r) const {
    put(r.plant, r.parameters, r.x);
    std::vector<double> step;
    std::vector<plant_model> plants = moved(r, 0, step);
    plants.insert(plants.begin(), r.plant);
    std::vector<std::vector<double>> e(plants.size());
    predictor_.run(plants, e);
    r.innovation = {std::move(e.front()), scoring_};
    e.erase(e.begin());
    for (std::size_t j = 0; j < e.size(); ++j) to_slope(e[j], r, step[j]);
    return {std::move(e), scoring_};
}

QUADRANT_DIAGNOSIS_DECL void fitter::evaluate(fit_result& r) const {
    put(r.plant, r.parameters, r.x);
    const double choices = predictor_.run(r.plant, r.innovation.rows);
    judge(r, choices);
}

QUADRANT_DIAGNOSIS_DECL void fitter::judge(fit_result& r, double choices) const {
    // As many of a block's rows are independent as its score says.
    double independent = 0;
    r.ms.clear();
    r.innovation.look(scoring_);
    for (std::size_t i = 0; i < scoring_.channels.size(); ++i) {
        independent += scoring_.channels[i].nu / static_cast<double>(scoring_.channels[i].block);
        r.ms.push_back(r.innovation.block_ms(scoring_, i));
    }
    r.choices = choices * independent;
    r.objective = score_ms(r.ms) + prior(r) + r.choices;
    if (!std::isfinite(r.objective)) r.objective = std::numeric_limits<double>::infinity();
}

QUADRANT_DIAGNOSIS_DECL double fitter::prior(const fit_result& r) {
    double sum = 0;
    for (Eigen::Index i = 0; i < r.x.size(); ++i)
        if (const auto& q = p(r.parameters, i); q.spread > 0)
            sum += 0.5 * square((r.x[i] - q.expected) / q.spread);
    return sum;
}

QUADRANT_DIAGNOSIS_DECL const parameter& fitter::p(const std::vector<parameter>& ps, Eigen::Index i) {
    return ps[static_cast<std::size_t>(i)];
}

QUADRANT_DIAGNOSIS_DECL std::vector<plant_model> fitter::moved(const fit_result& r, std::size_t first,
                                                               std::vector<double>& step) const {
    // The numbers of a replayed drive nearly stand for one another: what their slopes are wrong by must be
    // small beside what is left of them along that valley, or the fit stops where it reaches it. A difference
    // to one side is wrong by its step, as a share.
    constexpr double fine = 1e-6;
    const bool replayed = predictor_.drive && !predictor_.closed;
    std::vector<plant_model> plants;
    step.clear();
    for (std::size_t i = first; i < r.parameters.size(); ++i) {
        const auto& q = r.parameters[i];
        const double x = r.x[static_cast<Eigen::Index>(i)];
        const double size = !replayed ? q.step : q.logarithmic ? fine : 1e-3 * q.step;
        step.push_back(x + size > q.to_fit(q.high) ? -size : size);
        plants.push_back(r.plant);
        q.of(plants.back()) = q.from_fit(x + step.back());
    }
    return plants;
}

QUADRANT_DIAGNOSIS_DECL void fitter::to_slope(std::vector<double>& moved, const fit_result& r, double step) {
    const double inverse = 1 / step;
    for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = (moved[k] - r.innovation.rows[k]) * inverse;
}

QUADRANT_DIAGNOSIS_DECL void fitter::quadratics(fit_result& r, const std::vector<viewed_signal>& own,
                                                const known_slopes& known, bool curvature) const {
    r.quadratic.resize(scoring_.channels.size());
    for (std::size_t i = 0; i < scoring_.channels.size(); ++i)
        find_quadratics(r.quadratic[i], r.innovation, own, known, scoring_.channels[i], i, curvature);
}

QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd fitter::step(const fit_result& r, double damping, double& gain) const {
    const auto n = r.x.size();
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < r.quadratic.size(); ++i) add(r.quadratic[i], scoring_.channels[i], a, g);
    for (Eigen::Index i = 0; i < n; ++i)
        if (const auto& q = p(r.parameters, i); q.spread > 0) {
            a(i, i) += 1 / square(q.spread);
            g[i] += (r.x[i] - q.expected) / square(q.spread);
        }
    const Eigen::MatrixXd curvature = a;
    for (Eigen::Index i = 0; i < n; ++i) a(i, i) *= 1 + damping;
    Eigen::VectorXd low(n), high(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        low[i] = p(r.parameters, i).to_fit(p(r.parameters, i).low) - r.x[i];
        high[i] = p(r.parameters, i).to_fit(p(r.parameters, i).high) - r.x[i];
    }
    const Eigen::VectorXd d = bounded_step(a, g, low, high);
    gain = -(g.dot(d) + 0.5 * d.dot(curvature * d));
    return r.x + d;
}

QUADRANT_DIAGNOSIS_DECL void fitter::add(const block_quadratics& q, const channel& c, Eigen::MatrixXd& a,
                                         Eigen::VectorXd& g) {
    Eigen::MatrixXd scratch;
    for (std::size_t b = 0; b < q.size(); ++b) {
        const double w = c.nu / (q.ms[b] + c.least(b));
        a += w * q.curvature(b, scratch);
        g += w * q.gradient(b);
    }
}

} // namespace quadrant::inline v0::diagnosis
