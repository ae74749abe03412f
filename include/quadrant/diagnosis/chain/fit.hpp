// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "readings.hpp"

namespace quadrant::inline v0::diagnosis::chain {

inline constexpr std::size_t pieces = 30; ///< of a record; a fifth of them is predicted by the others
inline constexpr std::size_t folds_of = 5;
inline constexpr std::size_t most_blocks = 200, rows_of_block = 8; ///< at most, at least
inline constexpr double samples_of_block = 4; ///< that count: rows of one block repeat each other

/// Whether so many rows count that a model can be fitted to some pieces and predict the others.
inline bool says_enough(const readings& r) { return r.rows().size() >= 4 * pieces; }

/// One model on one link, its columns fitted by least squares.
struct fitted {
    link_model model;
    std::vector<std::optional<term>> of; ///< of each value
    Eigen::VectorXd values;
    Eigen::MatrixXd covariance; ///< from the scatter between pieces of the record
    double rms = 0;             ///< of what is left [m]
    double held_out = 0;        ///< the same on pieces that were predicted by the others [m]
    double score = 0;           ///< log-score of these
    Eigen::VectorXd left;       ///< at each row that counts [m]
    Eigen::MatrixXd columns;    ///< of the values

    /// What a term adds to the last reading, without its mean [m].
    Eigen::VectorXd part(term t) const {
        Eigen::VectorXd out = Eigen::VectorXd::Zero(left.size());
        for (std::size_t j = 0; j < of.size(); ++j)
            if (of[j] == t)
                out += columns.col(static_cast<Eigen::Index>(j)) * values[static_cast<Eigen::Index>(j)];
        return out.array() - out.mean();
    }
};

/// Normal equations of one piece.
struct normal_equations {
    Eigen::MatrixXd a;
    Eigen::VectorXd b;
};
QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd solved_normal(Eigen::MatrixXd a, const Eigen::VectorXd& b,
                                                      const Eigen::VectorXd& unit);

/// Fits the columns of a model; values that are no columns stay as they are.
QUADRANT_DIAGNOSIS_DECL fitted fit_columns(const readings& r, const link_model& m);

/// Calls `cost` at values between two ends and gives the best of what it saw: a grid by equal ratios, then
/// golden section around its best.
template <class Cost> double least(Cost cost, double low, double high, int grid, int steps) {
    std::vector<double> at(static_cast<std::size_t>(grid)), seen(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        at[i] = low * std::pow(high / low, static_cast<double>(i) / (grid - 1));
        seen[i] = cost(at[i]);
    }
    const auto best = static_cast<std::size_t>(std::min_element(seen.begin(), seen.end()) - seen.begin());
    double a = std::log(at[best > 0 ? best - 1 : 0]), b = std::log(at[std::min(best + 1, at.size() - 1)]);
    constexpr double g = 0.6180339887498949;
    double c = b - g * (b - a), d = a + g * (b - a), fc = cost(std::exp(c)), fd = cost(std::exp(d));
    for (int i = 0; i < steps; ++i) {
        if (fc < fd) {
            b = d, d = c, fd = fc;
            fc = cost(std::exp(c = b - g * (b - a)));
        } else {
            a = c, c = d, fc = fd;
            fd = cost(std::exp(d = a + g * (b - a)));
        }
    }
    return fc < fd ? std::exp(c) : std::exp(d);
}

/// Moves the play, the lag, the rate and, beside a play, the motor's friction of a model by what their columns
/// say, while that helps.
QUADRANT_DIAGNOSIS_DECL fitted settled(const readings& r, fitted f);

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "fit.ipp"
#endif
