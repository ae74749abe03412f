// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Equations sum over j of a[j] x[j] = b, one `add` each, solved in the least-squares sense by Householder QR
/// (so the condition of the matrix is not squared); bare numbers. Small problems: up to some hundred unknowns.
class least_squares {
public:
    explicit least_squares(std::size_t unknowns) : n_(unknowns) {
        require(unknowns > 0, "least_squares.unknowns", double(unknowns), "must be above 0");
    }
    /// a holds as many numbers as unknowns.
    void add(const std::vector<double>& a, double b) {
        require(a.size() == n_, "least_squares.add", double(a.size()), "must be one number for each unknown");
        rows_.push_back(a);
        rows_.back().push_back(b);
    }

    /// The unknowns, and what their intervals are made of.
    struct solution {
        std::vector<double> x;
        std::vector<double> inverse_diagonal; ///< of (A^T A)^-1: variance of x for unit variance of b
        double residual;                      ///< sum of squares
    };
    /// Throws when there are fewer equations than unknowns or an unknown is not determined by them.
    solution solve() const {
        require(rows_.size() >= n_, "least_squares.equations", double(rows_.size()),
                "must be no fewer than unknowns (" + quadrant::detail::shortest(double(n_)) + ")");
        auto a = rows_; // becomes R, with Q^T b in the last column
        double largest = 0;
        for (std::size_t k = 0; k < n_; ++k) {
            double norm = 0;
            for (std::size_t i = k; i < a.size(); ++i) norm = std::hypot(norm, a[i][k]);
            largest = std::max(largest, norm);
            require(std::isfinite(norm) && norm > 1e-13 * largest, "least_squares.column", double(k),
                    "must not be a combination of the others (pivot " + quadrant::detail::shortest(norm) + ")");
            const double pivot = a[k][k] > 0 ? -norm : norm;
            std::vector<double> v(a.size());
            for (std::size_t i = k; i < a.size(); ++i) v[i] = a[i][k];
            v[k] -= pivot;
            const double half = pivot * (pivot - a[k][k]); // v.v / 2
            for (std::size_t j = k; j <= n_; ++j) {
                double dot = 0;
                for (std::size_t i = k; i < a.size(); ++i) dot += v[i] * a[i][j];
                for (std::size_t i = k; i < a.size(); ++i) a[i][j] -= dot / half * v[i];
            }
        }
        solution out{std::vector<double>(n_), std::vector<double>(n_), 0};
        for (std::size_t k = n_; k-- > 0;) {
            double sum = a[k][n_];
            for (std::size_t j = k + 1; j < n_; ++j) sum -= a[k][j] * out.x[j];
            out.x[k] = sum / a[k][k];
        }
        for (std::size_t i = n_; i < a.size(); ++i) out.residual += a[i][n_] * a[i][n_];
        for (std::size_t c = 0; c < n_; ++c) { // column c of R^-1
            std::vector<double> e(c + 1);
            for (std::size_t k = c + 1; k-- > 0;) {
                double sum = k == c ? 1 : 0;
                for (std::size_t j = k + 1; j <= c; ++j) sum -= a[k][j] * e[j];
                e[k] = sum / a[k][k];
                out.inverse_diagonal[k] += e[k] * e[k];
            }
        }
        return out;
    }

private:
    std::size_t n_;
    std::vector<std::vector<double>> rows_;
};

} // namespace quadrant::inline v0::analysis
