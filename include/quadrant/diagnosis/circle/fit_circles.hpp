// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "patterns.hpp"

#include <Eigen/Dense>

namespace quadrant::inline v0::diagnosis::detail {

/// The mean of the samples of one turn within a small angle.
struct circle_bin {
    circle_point at;
    double deviation, weight;
};

/// A degree a bin, near reversals a quarter. What lies within 5 degrees of a reversal counts a tenth: it says
/// how high a spike is, but not much about the form of the circle (ball-bar evaluation leaves it out for that).
inline std::vector<circle_bin> binned(const std::vector<circle_run>& runs) {
    constexpr double degree = std::numbers::pi / 180, fine = degree / 4, near = 15 * degree, at = 5 * degree;
    const auto bin_of = [](double angle) {
        return from_reversal(angle) < near ? std::floor(angle / fine) : 1e7 + std::floor(angle / degree);
    };
    std::vector<circle_bin> bins;
    for (std::size_t j = 0; j < runs.size(); ++j) {
        const circle_run& r = runs[j];
        double angle = 0, deviation = 0, count = 0, bin = bin_of(r.angle[0]);
        const auto close = [&] {
            const double mean = angle / count, from = from_reversal(mean);
            bins.push_back({{mean, r.feed, r.radius, r.turning(), j, r.log},
                            deviation / count,
                            from < at     ? 0.1
                            : from < near ? 1.0
                                          : 4.0});
            angle = deviation = count = 0;
        };
        for (std::size_t k = 0; k < r.angle.size(); ++k) {
            if (const double now = bin_of(r.angle[k]); now != bin) close(), bin = now;
            angle += r.angle[k], deviation += r.deviation[k], ++count;
        }
        close();
    }
    return bins;
}

/// Weighted least squares over all runs at once, with columns in and out of the model.
class circle_fit {
public:
    circle_fit(const std::vector<circle_bin>& bins, const std::vector<circle_pattern>& patterns)
        : bins_(bins), columns_(static_cast<Eigen::Index>(patterns.size())) {
        const auto n = static_cast<Eigen::Index>(bins.size());
        a_.resize(n, columns_);
        b_.resize(n);
        range_ = largest_ = Eigen::VectorXd::Zero(columns_);
        Eigen::VectorXd low(columns_), high(columns_);
        for (Eigen::Index i = 0; i < n; ++i) {
            const circle_bin& bin = bins[static_cast<std::size_t>(i)];
            const double w = std::sqrt(bin.weight);
            const bool first = i == 0 || bins[static_cast<std::size_t>(i - 1)].at.run != bin.at.run;
            for (Eigen::Index c = 0; c < columns_; ++c) {
                const double v = patterns[static_cast<std::size_t>(c)].of(bin.at);
                a_(i, c) = w * v;
                low(c) = first ? v : std::min(low(c), v), high(c) = first ? v : std::max(high(c), v);
                range_(c) = std::max(range_(c), high(c) - low(c));
                largest_(c) = std::max(largest_(c), std::abs(v));
            }
            b_(i) = w * bin.deviation;
        }
        norm_ = a_.colwise().norm().cwiseMax(1e-300);
        a_.array().rowwise() /= norm_.transpose().array();
        gram_ = a_.transpose() * a_;
        right_ = a_.transpose() * b_;
        used_.assign(patterns.size(), false);
    }

    /// Circular error that a coefficient of 1 leaves in the worst run; of what is constant along the circle its
    /// largest value.
    double circularity(std::size_t c) const {
        const auto k = static_cast<Eigen::Index>(c);
        return range_(k) > 0 ? range_(k) : largest_(k);
    }
    bool used(std::size_t c) const { return used_[c]; }
    void use(std::size_t c, bool yes) { used_[c] = yes; }

    /// Takes column c in unless those that are in already say all but 2 % of it; returns those that do.
    std::vector<std::size_t> take_or_name(std::size_t c) {
        const auto in = indices();
        const auto col = static_cast<Eigen::Index>(c);
        if (gram_(col, col) < 0.5) return {c}; // zero in every run
        if (!in.empty()) {
            const Eigen::VectorXd along = gram_(in, col), share = gram_(in, in).ldlt().solve(along);
            if (1 - share.dot(along) < 0.02) {
                std::vector<std::size_t> same;
                for (Eigen::Index k = 0; k < share.size(); ++k)
                    if (std::abs(share(k)) > 0.3)
                        same.push_back(static_cast<std::size_t>(in[static_cast<std::size_t>(k)]));
                return same;
            }
        }
        used_[c] = true;
        return {};
    }

    /// Coefficients and standard errors of what is in; those of the others are 0. `afresh`: how alike
    /// neighbours err is worked out again, else it is that of the last time.
    void solve(bool afresh = true) {
        const auto in = indices();
        value_ = error_ = Eigen::VectorXd::Zero(columns_);
        const auto n = static_cast<Eigen::Index>(in.size());
        const Eigen::LDLT<Eigen::MatrixXd> factors(gram_(in, in));
        const Eigen::VectorXd right = right_(in), x = factors.solve(right);
        const Eigen::MatrixXd inverse = factors.solve(Eigen::MatrixXd::Identity(n, n));
        if (afresh) residual_ = b_ - a_(Eigen::all, in) * x, correlation_ = correlation();
        const double misfit = std::max(0.0, b_.squaredNorm() - right.dot(x));
        const double variance = misfit / std::max(1.0, double(b_.size() - n)) * correlation_;
        for (Eigen::Index k = 0; k < n; ++k) {
            const Eigen::Index c = in[static_cast<std::size_t>(k)];
            value_(c) = x(k) / norm_(c);
            error_(c) = std::sqrt(std::max(0.0, variance * inverse(k, k))) / norm_(c);
        }
    }
    double value(std::size_t c) const { return value_(static_cast<Eigen::Index>(c)); }
    double standard_error(std::size_t c) const { return error_(static_cast<Eigen::Index>(c)); }

    /// Root mean square of what neighbouring bins err alike, as of the last solve afresh: no noise, but what no
    /// column says.
    double structure() const {
        double product = 0, weight = 0;
        for (Eigen::Index i = 1; i < residual_.size(); ++i) {
            const auto &a = bins_[static_cast<std::size_t>(i - 1)], &b = bins_[static_cast<std::size_t>(i)];
            if (a.at.run != b.at.run) continue;
            product += residual_(i) * residual_(i - 1), weight += std::sqrt(a.weight * b.weight);
        }
        const double noise = 4 * residual_.squaredNorm() / std::sqrt(double(residual_.size()));
        return std::sqrt(std::max(0.0, product - noise) / std::max(weight, 1e-300));
    }

private:
    std::vector<Eigen::Index> indices() const {
        std::vector<Eigen::Index> in;
        for (std::size_t c = 0; c < used_.size(); ++c)
            if (used_[c]) in.push_back(static_cast<Eigen::Index>(c));
        return in;
    }
    /// By how much neighbours that err alike widen a variance: 1 + 2 sum of the residual's correlations within
    /// 30 bins.
    double correlation() const {
        constexpr Eigen::Index reach = 30;
        const double power = residual_.squaredNorm();
        double sum = 1;
        for (Eigen::Index lag = 1; lag <= reach && power > 0; ++lag) {
            double product = 0;
            for (Eigen::Index i = lag; i < residual_.size(); ++i)
                if (bins_[static_cast<std::size_t>(i)].at.run ==
                    bins_[static_cast<std::size_t>(i - lag)].at.run)
                    product += residual_(i) * residual_(i - lag);
            sum += 2 * (1 - double(lag) / (reach + 1)) * product / power;
        }
        return std::max(1.0, sum);
    }

    const std::vector<circle_bin>& bins_;
    Eigen::Index columns_;
    Eigen::MatrixXd a_, gram_;
    Eigen::VectorXd b_, right_, norm_, range_, largest_, value_, error_, residual_;
    double correlation_ = 1;
    std::vector<bool> used_;
};

} // namespace quadrant::inline v0::diagnosis::detail
