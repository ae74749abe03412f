// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Where the sum of squares of residuals(x) is least, seen from a start.
struct minimum {
    std::vector<double> x;
    std::vector<double> variance; ///< of x for unit variance of the residuals; infinite where not determined
    double cost;                  ///< sum of squares
    bool converged;
};

namespace detail {
inline double sum_of_squares(const std::vector<double>& r) {
    double sum = 0;
    for (const double each : r) sum += each * each;
    return sum;
}
/// Derivatives of residuals(x) by central differences, one column for each unknown.
template <class Residuals>
std::vector<std::vector<double>> central_differences(const Residuals& residuals, const std::vector<double>& x) {
    constexpr double h = 1e-5; // error h^2, rounding 1e-16/h
    std::vector<std::vector<double>> out(x.size());
    for (std::size_t j = 0; j < x.size(); ++j) {
        auto more = x, less = x;
        more[j] += h, less[j] -= h;
        out[j] = residuals(more);
        const auto below = residuals(less);
        for (std::size_t i = 0; i < below.size(); ++i) out[j][i] = (out[j][i] - below[i]) / (2 * h);
    }
    return out;
}
} // namespace detail

/// Nonlinear least squares after Levenberg and Marquardt, derivatives by central differences. Unknowns of size
/// about 1: scale them, take the logarithm of what must stay above 0. residuals: std::vector<double>(const
/// std::vector<double>&), always of one length. Deterministic; finds the minimum downhill of the start, no
/// other. Throws when the residuals at the start are not finite.
template <class Residuals> minimum minimise(const Residuals& residuals, std::vector<double> x) {
    const std::size_t n = x.size();
    std::vector<double> here = residuals(x);
    double cost = detail::sum_of_squares(here), damping = 1e-3;
    require(std::isfinite(cost), "minimise.residuals", cost, "must be finite at the start");
    auto slope = detail::central_differences(residuals, x);
    const auto equations = [&](double damped) {
        least_squares out(n);
        for (std::size_t i = 0; i < here.size(); ++i) {
            std::vector<double> row(n);
            for (std::size_t j = 0; j < n; ++j) row[j] = slope[j][i];
            out.add(row, -here[i]);
        }
        double largest = 0;
        for (const auto& column : slope) largest = std::max(largest, std::sqrt(detail::sum_of_squares(column)));
        for (std::size_t j = 0; damped > 0 && j < n; ++j) { // an unknown without effect stays where it is
            std::vector<double> row(n);
            row[j] = damped * std::max(std::sqrt(detail::sum_of_squares(slope[j])), 1e-6 * largest);
            out.add(row, 0);
        }
        return out.solve();
    };
    bool converged = cost == 0;
    for (int round = 0; round < 200 && !converged; ++round) {
        const auto step = equations(std::sqrt(damping)).x;
        auto next = x;
        double length = 0;
        for (std::size_t j = 0; j < n; ++j) next[j] += step[j], length = std::max(length, std::abs(step[j]));
        const auto there = residuals(next);
        const double more = detail::sum_of_squares(there);
        if (more <= cost) { // false where it is not a number
            converged = cost - more <= 1e-10 * cost && damping < 1;
            x = next, here = there, cost = more;
            damping = std::max(1e-8, 0.1 * damping);
            slope = detail::central_differences(residuals, x);
        } else {
            converged = length < 1e-9; // at the bottom, to rounding
            damping *= 10;
        }
    }
    minimum out{x, std::vector<double>(n, HUGE_VAL), cost, converged};
    try {
        out.variance = equations(0).inverse_diagonal;
    } catch (const invalid_parameter&) { // not determined: infinite, as above
    }
    return out;
}

} // namespace quadrant::inline v0::analysis
