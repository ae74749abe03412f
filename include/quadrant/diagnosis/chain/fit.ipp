// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis::chain {

QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd solved_normal(Eigen::MatrixXd a, const Eigen::VectorXd& b,
                                                      const Eigen::VectorXd& unit) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) a(j, j) += 1e-10 * unit[j];
    return a.ldlt().solve(b);
}

/// What fits to the other folds leave of each: rms and score.
inline void score_by_folds(fitted& out, const equations& q, const std::vector<normal_equations>& piece,
                           const normal_equations& all, const Eigen::VectorXd& unit, double noise) {
    const auto n = static_cast<std::size_t>(q.difference.size());
    std::array<Eigen::VectorXd, folds_of> without;
    for (std::size_t f = 0; f < folds_of; ++f) {
        normal_equations others = all;
        for (std::size_t p = f; p < pieces; p += folds_of) {
            others.a -= piece[p].a;
            others.b -= piece[p].b;
        }
        without[f] = solved_normal(others.a, others.b, unit);
    }
    const std::size_t blocks = std::clamp<std::size_t>(n / rows_of_block, 1, most_blocks);
    std::vector<double> sum(blocks, 0.0), count(blocks, 0.0);
    double total = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const double e = q.difference[row] - q.columns.row(row).dot(without[i * pieces / n % folds_of]);
        sum[i * blocks / n] += e * e;
        count[i * blocks / n] += 1;
        total += e * e;
    }
    out.held_out = std::sqrt(total / static_cast<double>(n));
    for (std::size_t b = 0; b < blocks; ++b)
        out.score -= samples_of_block / 2 * std::log(sum[b] / count[b] + noise * noise);
}

/// Nothing follows before it is asked: where a delay or a lag would end below zero its step is held at the one
/// to zero, and the others are fitted beside it.
inline void hold_at_zero(std::vector<normal_equations>& piece, const equations& q, const link_model& m,
                         const Eigen::VectorXd& values, const Eigen::VectorXd& unit) {
    for (std::size_t j = 0; j < q.of.size(); ++j) {
        if (!q.of[j] || !of_lateness(*q.of[j])) continue;
        const auto i = static_cast<Eigen::Index>(j);
        const double to_zero = -m.late(*q.of[j]);
        if (!(values[i] < to_zero)) continue;
        const double share = unit[i] / static_cast<double>(piece.size());
        for (normal_equations& p : piece) {
            p.b -= to_zero * p.a.col(i);
            p.a.col(i).setZero();
            p.a.row(i).setZero();
            p.a(i, i) = share;
            p.b[i] = share * to_zero;
        }
    }
}

QUADRANT_DIAGNOSIS_DECL fitted fit_columns(const readings& r, const link_model& m) {
    const equations q = r.of_model(m);
    const auto n = static_cast<std::size_t>(q.difference.size());
    const auto width = q.columns.cols();
    std::vector<normal_equations> piece(pieces,
                                        {Eigen::MatrixXd::Zero(width, width), Eigen::VectorXd::Zero(width)});
    for (std::size_t p = 0; p < pieces; ++p) {
        const std::size_t from = (p * n + pieces - 1) / pieces, to = ((p + 1) * n + pieces - 1) / pieces;
        const auto rows = static_cast<Eigen::Index>(to - from);
        if (rows == 0) continue;
        const auto c = q.columns.middleRows(static_cast<Eigen::Index>(from), rows);
        piece[p].a = c.transpose() * c;
        piece[p].b = c.transpose() * q.difference.segment(static_cast<Eigen::Index>(from), rows);
    }
    const auto sum = [&] {
        normal_equations out{Eigen::MatrixXd::Zero(width, width), Eigen::VectorXd::Zero(width)};
        for (const auto& p : piece) {
            out.a += p.a;
            out.b += p.b;
        }
        return out;
    };
    normal_equations all = sum();
    const Eigen::VectorXd unit = all.a.diagonal().cwiseMax(1e-300);
    if (m.has(term::delay) || m.has(term::first_order)) {
        hold_at_zero(piece, q, m, solved_normal(all.a, all.b, unit), unit);
        all = sum();
    }
    fitted out{.model = m,
               .of = q.of,
               .values = solved_normal(all.a, all.b, unit),
               .covariance = {},
               .left = {},
               .columns = q.columns};
    out.left = q.difference - q.columns * out.values;
    out.rms = std::sqrt(out.left.squaredNorm() / static_cast<double>(n));

    Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(width, width);
    for (const auto& p : piece) {
        const Eigen::VectorXd g = p.b - p.a * out.values;
        scatter += g * g.transpose();
    }
    Eigen::MatrixXd inverse = all.a;
    for (Eigen::Index j = 0; j < width; ++j) inverse(j, j) += 1e-10 * unit[j];
    inverse = inverse.ldlt().solve(Eigen::MatrixXd::Identity(width, width)).eval();
    out.covariance =
        inverse * scatter * inverse * (static_cast<double>(pieces) / (static_cast<double>(pieces) - 1));
    score_by_folds(out, q, piece, all, unit, r.noise());
    return out;
}

QUADRANT_DIAGNOSIS_DECL fitted settled(const readings& r, fitted f) {
    for (int round = 0; round < 8; ++round) {
        link_model next = f.model;
        double change = 0;
        for (std::size_t j = 0; j < f.of.size(); ++j) {
            const double by = f.values[static_cast<Eigen::Index>(j)];
            const bool first_of_its_term = j == 0 || f.of[j] != f.of[j - 1];
            if (f.of[j] == term::play && first_of_its_term) {
                next.play = std::max(next.play + by, 0.05 * next.play);
                change = std::max(change, std::abs(by) / std::max(next.play, 1e-300));
            }
            if (f.of[j] == term::motor_friction && f.model.play > 0) {
                double compliance = f.model.compliance;
                for (std::size_t i = 0; i < f.of.size(); ++i)
                    if (f.of[i] == term::spring) compliance += f.values[static_cast<Eigen::Index>(i)];
                if (!(compliance > 0)) continue;
                next.motor_coulomb = std::max(0.0, next.motor_coulomb + by / compliance);
                change = std::max(change, std::abs(by) / std::max(next.motor_coulomb * compliance, 1e-300));
            }
            if (f.of[j] == term::rate) {
                next.rate = std::max(next.rate + by, 0.05 * next.rate);
                change = std::max(change, std::abs(by) / std::max(next.rate, 1e-300));
            }
            if (f.of[j] && of_lateness(*f.of[j]) && first_of_its_term) {
                double& late = next.late(*f.of[j]);
                late = std::max(late + by, 0.0);
                change = std::max(change, std::abs(by) / std::max(late, 1e-3 * r.of().period));
            }
        }
        if (change < 1e-7) break;
        fitted moved = fit_columns(r, next);
        if (!(moved.rms <= f.rms * (1 + 1e-4))) break; // where the columns are exact the rms stays

        f = std::move(moved);
    }
    return f;
}

} // namespace quadrant::inline v0::diagnosis::chain
