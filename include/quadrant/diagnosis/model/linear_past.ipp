// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL linear_past linear_past::of(std::span<const double> e, std::span<const double> step,
                                                    std::span<const double> weight, std::size_t from) {
    constexpr std::size_t rows = 128;
    linear_past out;
    const auto n = 2 * order;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n + 1, n + 1), some(static_cast<Eigen::Index>(rows), n + 1);
    for (std::size_t k0 = from; k0 < e.size(); k0 += rows) {
        some.setZero();
        for (std::size_t k = k0; k < std::min(e.size(), k0 + rows); ++k) {
            auto row = some.row(static_cast<Eigen::Index>(k - k0));
            past(e, step, k, row);
            row[n] = e[k];
            row *= std::sqrt(weight[k]);
        }
        sum.selfadjointView<Eigen::Lower>().rankUpdate(some.transpose());
    }
    // Metres and volts in one matrix: solved in units of their own size.
    const Eigen::VectorXd scale = (sum.diagonal().array() + 1e-300).sqrt();
    const Eigen::MatrixXd whole = sum.selfadjointView<Eigen::Lower>();
    Eigen::MatrixXd a = scale.cwiseInverse().asDiagonal() * whole * scale.cwiseInverse().asDiagonal();
    Eigen::MatrixXd known = a.topLeftCorner(n, n);
    known.diagonal().array() += 1e-9;
    const Eigen::VectorXd solved = known.ldlt().solve(a.col(n).head(n));
    out.weights = (solved.array() / scale.head(n).array()) * scale[n];
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double>
linear_past::left(std::span<const double> e, std::span<const double> step, std::size_t from) const {
    std::vector<double> out(e.size(), 0.0);
    Eigen::RowVectorXd row(2 * order);
    for (std::size_t k = from; k < e.size(); ++k) {
        past(e, step, k, row);
        out[k] = e[k] - row.dot(weights);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> linear_past::left(const std::vector<double>& pulse) const {
    std::vector<double> out = pulse;
    for (std::size_t j = 0; j < pulse.size(); ++j)
        for (std::size_t i = 0; i < std::min(j, static_cast<std::size_t>(order)); ++i)
            out[j] -= weights[static_cast<Eigen::Index>(i)] * pulse[j - 1 - i];
    return out;
}

} // namespace quadrant::inline v0::diagnosis
