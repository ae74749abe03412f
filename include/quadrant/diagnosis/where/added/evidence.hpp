// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../fit/fit.hpp"
#include "../../fit/scoring.hpp"

#include <span>

namespace quadrant::inline v0::diagnosis::detail {

/// A signal as a sum of columns, fitted by least squares to four fifths of its blocks and compared with the
/// other fifth, five times. Neighbouring blocks are fitted and compared in turn, so that a part of the record
/// that happens once is in both.
class column_fit {
public:
    static constexpr std::size_t folds = 5;

    column_fit(std::span<const double> signal, const std::vector<std::vector<double>>& columns,
               std::size_t block)
        : signal_(signal), columns_(columns), block_(block), width_(static_cast<Eigen::Index>(columns.size())) {
        for (auto& sum : sums_) sum = {Eigen::MatrixXd::Zero(width_, width_), Eigen::VectorXd::Zero(width_)};
        Eigen::VectorXd row(width_);
        for (std::size_t k = 0; k < blocks() * block_; ++k) {
            for (Eigen::Index i = 0; i < width_; ++i) row[i] = columns_[static_cast<std::size_t>(i)][k];
            normal& sum = sums_[fold(k / block_)];
            sum.a.selfadjointView<Eigen::Lower>().rankUpdate(row);
            sum.b += row * signal_[k];
        }
        for (auto& sum : sums_) sum.a = sum.a.selfadjointView<Eigen::Lower>();
    }

    std::size_t blocks() const { return signal_.size() / block_; }
    /// Coefficients by the blocks for which `used` holds.
    template <class Used> Eigen::VectorXd by_folds(Used used) const {
        normal whole{Eigen::MatrixXd::Zero(width_, width_), Eigen::VectorXd::Zero(width_)};
        for (std::size_t f = 0; f < folds; ++f)
            if (used(f)) whole.a += sums_[f].a, whole.b += sums_[f].b;
        return solution(whole);
    }
    Eigen::VectorXd by_all() const {
        return by_folds([](std::size_t) { return true; });
    }
    /// Mean square of each block that was left out of its fit.
    std::vector<double> held_out_ms() const {
        std::array<Eigen::VectorXd, folds> x;
        for (std::size_t f = 0; f < folds; ++f) x[f] = by_folds([&](std::size_t other) { return other != f; });
        std::vector<double> out(blocks());
        for (std::size_t b = 0; b < out.size(); ++b) out[b] = ms_of(b, x[fold(b)]);
        return out;
    }
    /// Mean square of what is left of a block.
    double ms_of(std::size_t b, const Eigen::VectorXd& x) const {
        double sum = 0;
        for (std::size_t k = b * block_; k < (b + 1) * block_; ++k) {
            double left = signal_[k];
            for (Eigen::Index i = 0; i < width_; ++i) left -= x[i] * columns_[static_cast<std::size_t>(i)][k];
            sum += left * left;
        }
        return sum / static_cast<double>(block_);
    }
    /// Coefficients by the blocks for which `used(block)` holds.
    template <class Used> Eigen::VectorXd by_blocks(Used used) const {
        normal whole{Eigen::MatrixXd::Zero(width_, width_), Eigen::VectorXd::Zero(width_)};
        Eigen::VectorXd row(width_);
        for (std::size_t k = 0; k < blocks() * block_; ++k) {
            if (!used(k / block_)) continue;
            for (Eigen::Index i = 0; i < width_; ++i) row[i] = columns_[static_cast<std::size_t>(i)][k];
            whole.a += row * row.transpose();
            whole.b += row * signal_[k];
        }
        return solution(whole);
    }

private:
    struct normal {
        Eigen::MatrixXd a;
        Eigen::VectorXd b;
    };
    static std::size_t fold(std::size_t block) { return block % folds; }
    /// Columns are scaled to size one; one that is zero on these blocks gets nothing.
    Eigen::VectorXd solution(const normal& n) const {
        Eigen::MatrixXd a = n.a;
        Eigen::VectorXd b = n.b, scale(width_);
        for (Eigen::Index i = 0; i < width_; ++i)
            scale[i] = n.a(i, i) > 0 && std::isfinite(n.a(i, i)) ? 1 / std::sqrt(n.a(i, i)) : 0;
        a = scale.asDiagonal() * a * scale.asDiagonal();
        a.diagonal().array() += 1e-10;
        b = scale.asDiagonal() * b;
        return scale.asDiagonal() * solved(a, b);
    }

    std::span<const double> signal_;
    const std::vector<std::vector<double>>& columns_;
    std::size_t block_;
    Eigen::Index width_;
    std::array<normal, folds> sums_;
};

/// Log-score of blocks: that of the plant's innovations, with the floor of the replay [V^2].
inline double score_of_blocks(const std::vector<double>& ms, double floor, double numbers) {
    double sum = 0;
    for (double m : ms) sum += std::log(m + floor);
    return -0.5 * channel{}.nu * sum - numbers;
}
inline double mean_of(const std::vector<double>& x) {
    double sum = 0;
    for (double v : x) sum += v;
    return x.empty() ? 0 : sum / static_cast<double>(x.size());
}

} // namespace quadrant::inline v0::diagnosis::detail
