// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

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
                          std::span<const double> weight, std::size_t from);

    /// e less what its past says.
    std::vector<double> left(std::span<const double> e, std::span<const double> step, std::size_t from) const;

    /// What is left of a pulse in e.
    std::vector<double> left(const std::vector<double>& pulse) const;

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

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "linear_past.ipp"
#endif
