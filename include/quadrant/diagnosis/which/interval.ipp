// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL Eigen::MatrixXd covariance(const candidate& c, const scoring& s) {
    const auto n = c.fit.x.size();
    Eigen::MatrixXd h = c.curvature, scatter = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
    for (const auto& g : c.gradient.colwise()) mean += g / static_cast<double>(s.segments);
    for (const auto& g : c.gradient.colwise()) scatter += (g - mean) * (g - mean).transpose();
    if (s.segments > 1) scatter *= static_cast<double>(s.segments) / static_cast<double>(s.segments - 1);
    scatter += c.unknown;
    for (Eigen::Index i = 0; i < n; ++i)
        if (const auto& p = c.fit.parameters[static_cast<std::size_t>(i)]; p.spread > 0) {
            h(i, i) += 1 / (p.spread * p.spread);
            scatter(i, i) += 1 / (p.spread * p.spread);
        }
    h.diagonal() *= 1 + 1e-9;
    const Eigen::MatrixXd inverse = inverted(h);
    return inverse * scatter * inverse;
}

QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> estimates(const candidate& c, const effect& e,
                                                                  const scoring& s) {
    const auto n = c.fit.x.size();
    const Eigen::MatrixXd cov = covariance(c, s);
    const auto here = e.read(c.fit.plant);
    std::vector<std::vector<Eigen::VectorXd>> slope(here.size());
    for (std::size_t i = 0; i < here.size(); ++i)
        slope[i].assign(here[i].values.size(), Eigen::VectorXd::Zero(n));
    for (Eigen::Index j = 0; j < n; ++j) {
        const auto& p = c.fit.parameters[static_cast<std::size_t>(j)];
        plant_model moved = c.fit.plant;
        p.of(moved) = p.from_fit(c.fit.x[j] + p.step);
        const auto there = e.read(moved);
        for (std::size_t i = 0; i < here.size(); ++i)
            for (std::size_t k = 0; k < here[i].values.size(); ++k)
                slope[i][k][j] = (there[i].values[k] - here[i].values[k]) / p.step;
    }
    const double t =
        1.96 + 2.4 / std::max(1.0, static_cast<double>(s.segments) - 1); // Student's factor, two terms
    std::vector<parameter_estimate> out;
    for (std::size_t i = 0; i < here.size(); ++i) {
        parameter_estimate p{.key = here[i].key, .values = {}};
        for (std::size_t k = 0; k < here[i].values.size(); ++k) {
            const double half = t * std::sqrt(std::max(0.0, slope[i][k].dot(cov * slope[i][k])));
            p.values.push_back({here[i].values[k], here[i].values[k] - half, here[i].values[k] + half});
        }
        out.push_back(p);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void mark_bounds(const candidate& c, std::vector<parameter_estimate>& estimates) {
    for (parameter_estimate& e : estimates)
        if (c.ends_at_a_bound(e.key)) e.on_bound = true;
}

} // namespace quadrant::inline v0::diagnosis
