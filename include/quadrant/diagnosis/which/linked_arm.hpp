// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/regression.hpp"
#include "axis_case.hpp"

#include <array>
#include <span>

namespace quadrant::inline v0::diagnosis {

/// Two joints of one arm. The angle d of the outer one counts from the inner one, which carries it. Beside its
/// own M a + viscous v + coulomb sign v + weight sin(q - phase) + constant a joint then needs
///   inner: coupling (cos d (2 a + a') - sin d (2 v v' + v'^2)) + carried a' + weight sin(q + q' - phase)
///   outer: coupling (cos d a' + sin d v'^2)                    + carried a' + weight sin(q + q' - phase)
/// with a', v' and q' of the other joint. No machine file, which describes axis by axis, holds that.
struct linked_arm {
    std::string other;
    bool inner = false;     ///< this joint carries the other one
    regressed coulomb;      ///< of this joint [N m]; the spread is that between the folds
    double coupling = 0;    ///< mass of the outer link times both lever arms [kg m^2]
    double own_weight = 0;  ///< that follows the joint's own angle [N m]
    double both_weight = 0; ///< that follows the sum of both angles [N m]
    double alone = 0;       ///< rms of the torque that the joint's own terms leave on held-out motion [N m]
    double left = 0;        ///< the same with the other joint's terms
};

namespace detail {

/// Least squares in which each fold of the record is predicted by the others.
struct tested_regression {
    std::vector<Eigen::VectorXd> without{}; ///< each of the folds
    Eigen::VectorXd whole{};
    double left = 0; ///< rms on the folds that were left out

    tested_regression(const axis_record& r, const Eigen::MatrixXd& columns, const std::vector<double>& torque) {
        const Eigen::Index n = columns.cols();
        std::vector<regression_part> sums(folds, {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)});
        const auto counts = [&](std::size_t k) { return k >= r.score.skip && r.counts(k); };
        const auto row = [&](std::size_t k) { return columns.row(static_cast<Eigen::Index>(k)); };
        regression_part all = sums.front();
        for (std::size_t k = 0; k < torque.size(); ++k) {
            if (!counts(k)) continue;
            regression_part& part = sums[fold_of(r.segment[k])];
            part.left += row(k).transpose() * row(k);
            part.right += torque[k] * row(k).transpose();
        }
        for (const regression_part& part : sums) {
            all.left += part.left;
            all.right += part.right;
        }
        const auto solution = [&](Eigen::MatrixXd a, const Eigen::VectorXd& b) -> Eigen::VectorXd {
            a.diagonal() *= 1 + 1e-9;
            return solved(a, b);
        };
        for (const regression_part& part : sums)
            without.push_back(solution(all.left - part.left, all.right - part.right));
        whole = solution(all.left, all.right);
        double sum = 0, rows = 0;
        for (std::size_t k = 0; k < torque.size(); ++k)
            if (counts(k)) {
                sum += square(torque[k] - row(k).dot(without[fold_of(r.segment[k])]));
                ++rows;
            }
        left = std::sqrt(sum / std::max(1.0, rows));
    }

    regressed number(Eigen::Index i) const {
        double mean = 0, sum = 0;
        for (const auto& x : without) mean += x[i] / static_cast<double>(folds);
        for (const auto& x : without) sum += square(x[i] - mean);
        return {whole[i], std::sqrt(sum * static_cast<double>(folds - 1) / static_cast<double>(folds))};
    }
    double size(Eigen::Index i) const { return std::hypot(whole[i], whole[i + 1]); } ///< of a sine and a cosine
};

/// The columns of both laws along the motions of two joints, smoothed alike.
class arm_columns {
public:
    static constexpr Eigen::Index coulomb = 2, own_weight = 3, coupling = 6, both_weight = 9;

    arm_columns(const axis_record& r, const std::vector<double>& other)
        : r_(r), own_(r, r.position), other_(r, other) {}

    Eigen::MatrixXd alone() const {
        return columns<6>([&](std::size_t k) {
            const double v = own_.v[k], sign = v > 0 ? 1 : v < 0 ? -1 : 0;
            return std::array{own_.a[k], v, sign, std::sin(own_.q[k]), std::cos(own_.q[k]), 1.0};
        });
    }
    /// Cosine and sine of the angle between, for nobody knows where it is zero.
    Eigen::MatrixXd linked(bool inner) const {
        return columns<5>([&](std::size_t k) {
            const double d = (inner ? other_ : own_).q[k], c = std::cos(d), s = std::sin(d);
            const double v = other_.v[k], a = other_.a[k], both = own_.q[k] + other_.q[k];
            const double turns = inner ? 2 * own_.a[k] + a : a,
                         swings = inner ? 2 * own_.v[k] * v + v * v : -v * v;
            return std::array{c * turns - s * swings, s * turns + c * swings, a, std::sin(both),
                              std::cos(both)};
        });
    }
    std::vector<double> torque(double constant) const {
        std::vector<double> out(r_.command.begin(), r_.command.end());
        for (double& u : out) u *= constant;
        return smooth(r_, smooth(r_, out)); // as often as the columns
    }

private:
    static std::vector<double> smooth(const axis_record& r, std::span<const double> x) {
        return zero_phase(x, r.bandwidth_Hz, r.period);
    }
    struct motion {
        std::vector<double> q, v, a;
        motion(const axis_record& r, std::span<const double> angle)
            : q(smooth(r, angle)), v(derivative(q, r.period)), a(derivative(v, r.period)) {}
    };
    template <std::size_t N, class Row> Eigen::MatrixXd columns(Row row) const {
        Eigen::MatrixXd out(static_cast<Eigen::Index>(own_.q.size()), static_cast<Eigen::Index>(N));
        for (std::size_t i = 0; i < N; ++i) {
            std::vector<double> x;
            for (std::size_t k = 0; k < own_.q.size(); ++k) x.push_back(row(k)[i]);
            x = smooth(r_, x);
            out.col(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::VectorXd>(x.data(), out.rows());
        }
        return out;
    }

    const axis_record& r_;
    motion own_, other_;
};

inline linked_arm linked(const axis_case& c, const std::vector<double>& other, bool inner) {
    const arm_columns of(c.record, other);
    const auto torque = of.torque(c.axis.plant.force_constant_N_per_V);
    const Eigen::MatrixXd own = of.alone();
    Eigen::MatrixXd all(own.rows(), own.cols() + 5);
    all << own, of.linked(inner);
    const tested_regression found(c.record, all, torque);
    return {.other = {},
            .inner = inner,
            .coulomb = found.number(arm_columns::coulomb),
            .coupling = found.size(arm_columns::coupling),
            .own_weight = found.size(arm_columns::own_weight),
            .both_weight = found.size(arm_columns::both_weight),
            .alone = tested_regression(c.record, own, torque).left,
            .left = found.left};
}

} // namespace detail

/// Whether a rotary axis moves as a link of one arm with another axis of the log: the one with which least is
/// left; none where that is more than half, in energy, of what the axis' own terms leave. `others` and
/// `rows_in_one` as inertia_by_angle() has them.
inline std::optional<linked_arm> arm_of(const axis_case& c, std::span<const axis_log* const> others,
                                        std::size_t rows_in_one) {
    if (c.axis.kind != axis_kind::rotary || c.record.closed() || c.axis.drive.closes()) return {};
    std::optional<linked_arm> best;
    for (const axis_log* other : others) {
        if (other->kind != axis_kind::rotary || other->still || other->name == c.axis.name) continue;
        std::vector<double> angle(c.record.position.size());
        if (other->position.size() < angle.size() * rows_in_one) continue;
        for (std::size_t k = 0; k < angle.size(); ++k)
            angle[k] = other->position[k * rows_in_one + (rows_in_one - 1) / 2];
        for (const bool inner : {true, false}) {
            linked_arm found = detail::linked(c, angle, inner);
            found.other = other->name;
            if (square(found.left) < square(found.alone) / 2 && (!best || found.left < best->left))
                best = std::move(found);
        }
    }
    return best;
}

} // namespace quadrant::inline v0::diagnosis
