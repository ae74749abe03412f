// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL double noise_gain(double band_Hz, double period) {
    std::vector<double> impulse(2001, 0.0);
    impulse[1000] = 1;
    double sum = 0;
    for (double a : derivative(derivative(zero_phase(impulse, band_Hz, period), period), period)) sum += a * a;
    return sum;
}

QUADRANT_DIAGNOSIS_DECL double mean_square(const std::vector<double>& x) {
    double sum = 0;
    for (double v : x) sum += v * v / static_cast<double>(x.size());
    return sum;
}

QUADRANT_DIAGNOSIS_DECL double regression_band(const axis_log& log, double period, bool to_noise) {
    constexpr double finer = 0.8, share = 0.01, motion = 0.98;
    const double noise = reading_noise(log.position, log.position_step);
    const double least = 8 / (period * static_cast<double>(log.position.size()));
    const auto velocity = [&](double band) {
        return derivative(zero_phase(log.position, band, period), period);
    };
    double band = widest_band(period);
    const auto drowned = [&](double f) {
        return noise * noise * noise_gain(f, period) > share * mean_square(derivative(velocity(f), period));
    };
    while (band > least && drowned(band)) band *= finer;
    if (!(band > least)) return 0;
    if (to_noise) return band;
    const double all = mean_square(velocity(band));
    double slowest = band;
    while (slowest * finer > least && mean_square(velocity(slowest * finer)) > motion * all) slowest *= finer;
    return std::min(band, 3 * slowest);
}

/// Pieces of a record between gaps: rows from, rows to. A few rows in a row that do not count are no gap, and
/// what is too short behind a low-pass is no piece.
inline std::vector<std::pair<std::size_t, std::size_t>> pieces_between_gaps(const axis_log& log, double band_Hz,
                                                                            double period) {
    const std::size_t n = log.position.size();
    const double few = std::max(2.0, 0.25 / (band_Hz * period)), least = 1 / (band_Hz * period);
    const auto gap = long_gaps(log.left_out, few, 0).gap;
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (std::size_t from = 0; from < n;) {
        std::size_t to = from;
        while (to < n && (gap.empty() || !gap[to])) ++to;
        if (static_cast<double>(to - from) > least) out.emplace_back(from, to);
        from = to + 1;
    }
    return out;
}

/// What a regression explains the command by, and the command, all behind the same low-pass; 0 in gaps.
struct regression_signals {
    regression_signals(const axis_log& log, double band_Hz, double period) {
        for (auto* each : {&v, &a, &u, &slope, &curve, &direction, &sine, &cosine})
            each->assign(log.position.size(), 0.0);
        for (const auto& [from, to] : pieces_between_gaps(log, band_Hz, period)) {
            const auto piece = [&, first = from, last = to](const std::vector<double>& x) {
                return std::vector(x.begin() + static_cast<std::ptrdiff_t>(first),
                                   x.begin() + static_cast<std::ptrdiff_t>(last));
            };
            const auto put = [&, first = from](std::vector<double>& to_all, const std::vector<double>& x) {
                std::copy(x.begin(), x.end(), to_all.begin() + static_cast<std::ptrdiff_t>(first));
            };
            const auto filtered = [&](const std::vector<double>& of, auto term) {
                std::vector<double> x;
                for (const double z : of) x.push_back(term(z));
                return zero_phase(x, band_Hz, period);
            };
            const std::vector<double> position = piece(log.position), command = piece(log.command);
            const auto speed = derivative(zero_phase(position, band_Hz, period), period);
            const auto asked = zero_phase(command, band_Hz, period), rise = derivative(asked, period);
            put(v, speed);
            put(a, derivative(speed, period));
            put(u, asked);
            put(slope, rise);
            put(curve, derivative(rise, period));
            put(direction, filtered(speed, [](double z) { return z > 0 ? 1.0 : z < 0 ? -1.0 : 0.0; }));
            put(sine, filtered(position, [](double z) { return std::sin(z); }));
            put(cosine, filtered(position, [](double z) { return std::cos(z); }));
        }
    }
    std::vector<double> v{}, a{}, u{}, slope{}, curve{}, direction{}, sine{}, cosine{};
};

inline double largest(const std::vector<double>& x) {
    return std::max(std::abs(*std::max_element(x.begin(), x.end())),
                    std::abs(*std::min_element(x.begin(), x.end())));
}

/// The normal equations of all parts but one.
inline regression_part sum_without(const std::vector<regression_part>& parts, std::size_t one) {
    regression_part out{Eigen::MatrixXd::Zero(parts[0].left.rows(), parts[0].left.cols()),
                        Eigen::VectorXd::Zero(parts[0].right.size())};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i == one) continue;
        out.left += parts[i].left;
        out.right += parts[i].right;
    }
    return out;
}

/// White noise of the command is in its derivatives, too: what it adds to the normal equations is taken out.
/// from: number of the slope, behind which the second derivative stands.
inline void take_noise_out(std::vector<regression_part>& parts, double white_noise, double band_Hz,
                           double period, Eigen::Index from) {
    std::vector<double> impulse(2001, 0.0);
    impulse[1000] = white_noise;
    const auto slope = derivative(zero_phase(impulse, band_Hz, period), period),
               curve = derivative(slope, period);
    const double of_slope = std::inner_product(slope.begin(), slope.end(), slope.begin(), 0.0),
                 of_curve = std::inner_product(curve.begin(), curve.end(), curve.begin(), 0.0);
    for (regression_part& p : parts) {
        const double rows = p.left(3, 3);
        p.left(from, from) -= rows * of_slope;
        p.left(from + 1, from + 1) -= rows * of_curve;
        p.right[from + 1] += rows * of_slope; // n n'' has the mean of -n'^2
    }
}

/// Whether the command is a P or PD law of the position itself, but for a thousandth of its variance, while
/// the axis moves: then it is anything that the motion is a sum of, its gain a weight among them. Friction
/// needs a command that grows with the speed, such a law has none. `speed`: of every row; slower rows than
/// `least` are left out.
inline bool is_law_of_position(const axis_log& log, const std::vector<double>& speed, double least) {
    Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    const double x0 = log.position.front();
    double energy = 0, sum = 0, rows = 0;
    for (std::size_t k = 1; k < log.position.size(); ++k) {
        if (std::abs(speed[k]) < least) continue;
        const double u = log.command[k];
        const Eigen::Vector3d row{1, log.position[k] - x0, log.position[k] - log.position[k - 1]};
        left += row * row.transpose();
        right += u * row;
        energy += u * u, sum += u, rows += 1;
    }
    const double variance = energy - sum * sum / std::max(1.0, rows);
    if (!(variance > 1e-12 * energy)) return false;
    const Eigen::Vector3d scale = left.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::Matrix3d even = scale.asDiagonal() * left * scale.asDiagonal();
    const Eigen::Vector3d by = scale.asDiagonal() * right;
    const Eigen::Vector3d found = even.ldlt().solve(by), of_each = scale.asDiagonal() * found;
    const bool drives_back =
        of_each[1] < 0 && found[2] * std::sqrt(left(2, 2)) * scale[2] < 0.01 * std::sqrt(variance);
    return drives_back && energy - by.dot(found) < 1e-3 * variance;
}

/// The direction of a record that goes one way, 1 or -1; else 0.
inline double direction_of_all(const regression_part& all) {
    constexpr double few = 1e-4; // share of the rows that go the other way
    const double mean = all.left(2, 3) / all.left(3, 3);
    return all.left(2, 2) / all.left(3, 3) - mean * mean < 4 * few ? std::copysign(1.0, mean) : 0;
}

/// Shares of the command's variance that are left with its derivatives and without. energy: of the command;
/// n: numbers before those of its derivatives.
inline void add_shares_left(axis_regression& out, const regression_part& all, double energy,
                            const Eigen::VectorXd& whole, Eigen::Index n) {
    const double variance = energy - all.right[3] * all.right[3] / all.left(3, 3);
    const Eigen::VectorXd in_time = solved(all.left.topLeftCorner(n, n), all.right.head(n));
    out.left = (energy - all.right.dot(whole)) / variance;
    out.left_in_time = (energy - all.right.head(n).dot(in_time)) / variance;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL axis_regression regress(const axis_log& log, double period, and_lateness asked,
                                                double white_noise) {
    axis_regression out;
    out.band_Hz = detail::regression_band(
        log, period, asked == and_lateness::up_to_noise || asked == and_lateness::with_curvature);
    if (!(out.band_Hz > 0)) return out;
    const detail::regression_signals of(log, out.band_Hz, period);
    const double fastest = detail::largest(of.v);
    constexpr std::size_t parts = 16;
    const std::size_t rows = of.v.size() / parts;
    if (rows < 8 || !(detail::largest(of.a) > 0)) return {};
    const bool turns = log.kind == axis_kind::rotary, lateness = asked != and_lateness::no;
    const bool curvature = asked == and_lateness::with_curvature;
    const Eigen::Index of_axis = turns ? 6 : 4, n = of_axis + (curvature ? 2 : lateness ? 1 : 0);
    std::vector<detail::regression_part> sums(parts, {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)});
    double energy = 0; // of the command
    for (std::size_t k = 0; k < parts * rows; ++k) {
        if (std::abs(of.v[k]) < 0.03 * fastest || (lateness && std::abs(of.direction[k]) < 0.98)) continue;
        Eigen::VectorXd row(n);
        row.head<4>() << of.a[k], of.v[k], of.direction[k], 1;
        if (turns) row.segment<2>(4) << of.sine[k], of.cosine[k];
        if (lateness) row[of_axis] = -of.slope[k];
        if (curvature) row[of_axis + 1] = of.curve[k];
        sums[k / rows].left += row * row.transpose();
        sums[k / rows].right += of.u[k] * row;
        energy += of.u[k] * of.u[k];
    }
    if (curvature) detail::take_noise_out(sums, white_noise, out.band_Hz, period, of_axis);
    const auto solution = [&](std::size_t without) {
        auto [left, right] = detail::sum_without(sums, without);
        left.diagonal() *= 1 + 1e-9;
        return Eigen::VectorXd(solved(left, right));
    };
    const Eigen::VectorXd whole = solution(parts);
    const detail::regression_part all = detail::sum_without(sums, parts);
    const double onwards = detail::direction_of_all(all);
    Eigen::VectorXd square = Eigen::VectorXd::Zero(n); // jackknife over the parts
    double square_of_both = 0;
    for (std::size_t i = 0; i < parts; ++i) {
        const Eigen::VectorXd off = solution(i) - whole;
        constexpr double weight = (parts - 1.0) / static_cast<double>(parts);
        square += off.cwiseAbs2() * weight;
        square_of_both += (off[2] + onwards * off[3]) * (off[2] + onwards * off[3]) * weight;
    }
    const auto number = [&](Eigen::Index i) { return regressed{whole[i], std::sqrt(square[i])}; };
    out.acceleration = number(0), out.speed = number(1);
    if (onwards == 0) out.direction = number(2), out.mean = number(3);
    if (onwards != 0) out.resists = {whole[2] + onwards * whole[3], std::sqrt(square_of_both)};
    if (lateness) out.lateness = number(of_axis);
    detail::add_shares_left(out, all, energy, whole, of_axis);
    if (curvature) out.curvature = number(of_axis + 1);
    if (turns) {
        out.weight = {std::hypot(whole[4], whole[5]), std::sqrt(square[4] + square[5])};
        out.phase = std::atan2(-whole[5], whole[4]);
        if (detail::is_law_of_position(log, of.v, 0.03 * fastest)) out.nothing_of_the_axis();
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
