// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

template <class Right> Right solved_in_own_size(const Eigen::MatrixXd& a, const Right& b) {
    const Eigen::VectorXd size =
        a.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1.0; });
    const Eigen::MatrixXd even = size.asDiagonal() * a * size.asDiagonal();
    return size.asDiagonal() * even.ldlt().solve(size.asDiagonal() * b);
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd solved(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
    return detail::solved_in_own_size(a, b);
}

QUADRANT_DIAGNOSIS_DECL Eigen::MatrixXd inverted(const Eigen::MatrixXd& a) {
    return detail::solved_in_own_size<Eigen::MatrixXd>(a, Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd bounded_step(const Eigen::MatrixXd& a, const Eigen::VectorXd& g,
                                                     const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
    const Eigen::Index n = g.size();
    std::vector<bool> fixed(static_cast<std::size_t>(n), false);
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
    for (Eigen::Index round = 0; round <= n; ++round) {
        std::vector<Eigen::Index> open;
        Eigen::VectorXd on_bounds = d;
        for (Eigen::Index i = 0; i < n; ++i)
            if (!fixed[static_cast<std::size_t>(i)]) {
                open.push_back(i);
                on_bounds[i] = 0;
            }
        if (open.empty()) break;
        const Eigen::VectorXd right = -(g + a * on_bounds);
        const Eigen::MatrixXd sub = a(open, open);
        const Eigen::VectorXd free = solved(sub, Eigen::VectorXd(right(open)));
        bool clipped = false;
        for (std::size_t j = 0; j < open.size(); ++j) {
            const auto i = open[j];
            d[i] = free[static_cast<Eigen::Index>(j)];
            if (d[i] >= low[i] && d[i] <= high[i]) continue;
            d[i] = std::clamp(std::isfinite(d[i]) ? d[i] : 0.0, low[i], high[i]);
            fixed[static_cast<std::size_t>(i)] = clipped = true;
        }
        if (!clipped) break;
    }
    return d;
}

} // namespace quadrant::inline v0::diagnosis
