// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::diagnosis {

/// What of an innovation follows linearly from what was known before it: its own last rows and the last steps
/// of the command,
///   e[k] ~ sum of_innovation[i] e[k-1-i] + sum of_step[i] step[k-1-i]
/// (ARX [Ljung1999] ch. 4, weighted least squares). What is left is white and unrelated to the command: sensor
/// noise that came back through the feedback, a delay, a lag or a gain that is not as modelled are all in the
/// sum.
struct linear_past {
    static constexpr Eigen::Index order = 10;
    static constexpr std::size_t first = 10; ///< row that has a past

    Eigen::VectorXd weights = Eigen::VectorXd::Zero(2 * order);

    /// `weight`: one a row, from `from` on.
    static linear_past of(std::span<const double> e, std::span<const double> step,
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

    /// e less what its past says.
    std::vector<double> left(std::span<const double> e, std::span<const double> step, std::size_t from) const {
        std::vector<double> out(e.size(), 0.0);
        Eigen::RowVectorXd row(2 * order);
        for (std::size_t k = from; k < e.size(); ++k) {
            past(e, step, k, row);
            out[k] = e[k] - row.dot(weights);
        }
        return out;
    }

    /// What is left of a pulse in e.
    std::vector<double> left(const std::vector<double>& pulse) const {
        std::vector<double> out = pulse;
        for (std::size_t j = 0; j < pulse.size(); ++j)
            for (std::size_t i = 0; i < std::min(j, static_cast<std::size_t>(order)); ++i)
                out[j] -= weights[static_cast<Eigen::Index>(i)] * pulse[j - 1 - i];
        return out;
    }

    /// Variance of what is left of white noise, in its own.
    double noise_gain() const { return 1 + weights.head(order).squaredNorm(); }

private:
    template <class Row>
    static void past(std::span<const double> e, std::span<const double> step, std::size_t k, Row&& row) {
        for (Eigen::Index i = 0; i < order; ++i) {
            row[i] = e[k - 1 - static_cast<std::size_t>(i)];
            row[order + i] = step[k - 1 - static_cast<std::size_t>(i)];
        }
    }
};

} // namespace quadrant::diagnosis
