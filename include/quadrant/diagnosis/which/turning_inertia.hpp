// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/regression.hpp"
#include "axis_case.hpp"

#include <span>

namespace quadrant::inline v0::diagnosis {

/// An inertia that turns with the angle of another axis, as that of an arm does with its elbow:
///   M + cosine cos(q2) + sine sin(q2)
/// No machine file can describe it; where it is what is left of a gap, it is told.
struct turning_inertia {
    std::string other;           ///< the axis whose angle it is
    double cosine = 0, sine = 0; ///< [kg m^2]
    double share = 0;            ///< of the energy above the floor, of motion that the fit did not use
    double left = 0;             ///< rms of the force that stays there [N m]

    double swing() const { return std::hypot(cosine, sine); }
};

namespace detail {

/// What such an inertia needs along a motion beside its mean is, by the angle's cosine and sine,
/// (M(q2) - mean) a + dM/dq2 v2 v. The mean is the machine's own number: free, it would do what gravity does.
inline Eigen::MatrixXd turning_columns(const axis_record& r, const std::vector<double>& angle) {
    const auto smooth = [&](const std::vector<double>& x) { return zero_phase(x, r.bandwidth_Hz, r.period); };
    const auto q = smooth({r.position.begin(), r.position.end()}), v = derivative(q, r.period),
               a = derivative(v, r.period), q2 = smooth(angle), v2 = derivative(q2, r.period);
    double mean_cosine = 0, mean_sine = 0;
    for (const double x : q2) {
        mean_cosine += std::cos(x) / static_cast<double>(q2.size());
        mean_sine += std::sin(x) / static_cast<double>(q2.size());
    }
    std::vector<double> by_cosine(q.size()), by_sine(q.size());
    for (std::size_t k = 0; k < q.size(); ++k) {
        const double c = std::cos(q2[k]), s = std::sin(q2[k]), turn = v2[k] * v[k];
        by_cosine[k] = (c - mean_cosine) * a[k] - s * turn;
        by_sine[k] = (s - mean_sine) * a[k] + c * turn;
    }
    by_cosine = smooth(by_cosine);
    by_sine = smooth(by_sine);
    Eigen::MatrixXd out(static_cast<Eigen::Index>(q.size()), 2);
    for (std::size_t k = 0; k < q.size(); ++k)
        out.row(static_cast<Eigen::Index>(k)) << by_cosine[k], by_sine[k];
    return out;
}

/// Fitted to what a model leaves, without the fold in which it is tested.
inline turning_inertia fitted_inertia(const axis_case& c, const Eigen::MatrixXd& columns,
                                      const std::vector<double>& residual) {
    const axis_record& r = c.record;
    std::vector<regression_part> sums(folds, {Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2)});
    const auto counts = [&](std::size_t k) { return k >= r.score.skip && r.counts(k); };
    for (std::size_t k = 0; k < residual.size(); ++k) {
        if (!counts(k)) continue;
        const Eigen::VectorXd row = columns.row(static_cast<Eigen::Index>(k)).transpose();
        sums[fold_of(r.segment[k])].left += row * row.transpose();
        sums[fold_of(r.segment[k])].right += residual[k] * row;
    }
    const auto solution = [&](std::size_t without) {
        Eigen::MatrixXd left = Eigen::MatrixXd::Zero(2, 2);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(2);
        for (std::size_t f = 0; f < folds; ++f) {
            if (f == without) continue;
            left += sums[f].left;
            right += sums[f].right;
        }
        left.diagonal() *= 1 + 1e-9;
        return solved(left, right);
    };
    double before = 0, after = 0, rows = 0;
    std::vector<Eigen::VectorXd> by_fold;
    for (std::size_t f = 0; f < folds; ++f) by_fold.push_back(solution(f));
    for (std::size_t k = 0; k < residual.size(); ++k) {
        if (!counts(k)) continue;
        const double left =
            residual[k] - columns.row(static_cast<Eigen::Index>(k)).dot(by_fold[fold_of(r.segment[k])]);
        before += residual[k] * residual[k];
        after += left * left;
        ++rows;
    }
    const Eigen::VectorXd whole = solution(folds);
    const double floor = rows * c.floor_force() * c.floor_force();
    turning_inertia out{.other = {}, .cosine = whole[0], .sine = whole[1]};
    out.left = std::sqrt(after / std::max(1.0, rows));
    out.share = before > floor ? (before - after) / (before - floor) : 0;
    return out;
}

} // namespace detail

/// What such an inertia takes off what a model of a rotary axis leaves open, by the other axis that fits best;
/// none where that is less than half. `others`: rotary axes of the same log, of which each of this axis'
/// samples is `rows_in_one`.
inline std::optional<turning_inertia> inertia_by_angle(const axis_case& c, const candidate& m,
                                                       std::span<const axis_log* const> others,
                                                       std::size_t rows_in_one) {
    if (c.axis.kind != axis_kind::rotary || c.record.closed()) return {};
    const auto residual = c.models.residual(m);
    std::optional<turning_inertia> best;
    for (const axis_log* other : others) {
        if (other->kind != axis_kind::rotary || other->still || other->name == c.axis.name) continue;
        std::vector<double> angle(residual.size());
        if (other->position.size() < angle.size() * rows_in_one) continue;
        for (std::size_t k = 0; k < angle.size(); ++k)
            angle[k] = other->position[k * rows_in_one + (rows_in_one - 1) / 2];
        turning_inertia found = detail::fitted_inertia(c, detail::turning_columns(c.record, angle), residual);
        found.other = other->name;
        if (found.share > 0.5 && (!best || found.share > best->share)) best = std::move(found);
    }
    return best;
}

} // namespace quadrant::inline v0::diagnosis
