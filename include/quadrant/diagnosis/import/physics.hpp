// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/scales.hpp"
#include "../log/log.hpp"

#include <Eigen/Dense>

namespace quadrant::inline v0::diagnosis {

/// What physics says of the units of one axis. Nothing here has an absolute scale.
struct unit_check {
    double position_per_reference = 1; ///< slope of the position over the reference: 1 when both have one unit
    double correlation = 0;            ///< of the two
    double velocity_per_position = 1;  ///< slope of a velocity column over that of the position: 1, too
    double velocity_correlation = 0;   ///< of the two; 0: no column
    double travel = 0, peak_speed = 0,
           peak_acceleration = 0; ///< of the position, below `corner_Hz` [m], [m/s], [m/s^2]
    double corner_Hz = 0;         ///< up to it the acceleration stands ten times above the reading's noise
    double command_per_acceleration =
        0;             ///< A of command = A a + B v + C sign v + D + E x (and sin x, cos x of an angle)
    double spread = 0; ///< standard deviation of A, from stretches of five blocks
    double share = 0;  ///< of the command's variance that the acceleration alone explains beside the rest
    double share_of_left = 0; ///< the same, of the variance that the rest leaves; A over it: the most A can be
    /// What moving costs on average, B |v| + C [unit of the command]: friction takes it, so it is not negative;
    /// its standard deviation, and the share of the command's variance that speed and direction explain.
    double friction = 0, friction_spread = 0, friction_share = 0;
    bool sign_is_known() const { return std::abs(command_per_acceleration) > 4 * spread; }
};

namespace detail {

/// The highest frequency up to which the acceleration of a record is ten times as strong as the noise of its
/// reading, between 20 cycles in the record and 17 rows in a cycle.
inline double motion_corner(std::span<const double> position, double period, double count) {
    const double noise = reading_noise(position, count);
    const double most = 0.06 / period,
                 least = std::min(most, 20 / (static_cast<double>(position.size()) * period));
    double corner = most;
    for (; corner > least; corner /= 1.5) {
        const auto a = derivative(derivative(zero_phase(position, corner, period), period), period);
        const double w = 2 * std::numbers::pi * corner;
        if (rms(a) > 10 * noise * w * w * std::sqrt(2 * corner * period)) break; // white noise below the corner
    }
    return std::max(corner, least);
}

/// The sums of a regression over some rows: of products of its terms, of terms and command, of the command's
/// square.
template <int Terms> struct regression_sums {
    Eigen::Matrix<double, Terms, Terms> left = Eigen::Matrix<double, Terms, Terms>::Zero();
    Eigen::Matrix<double, Terms, 1> right = Eigen::Matrix<double, Terms, 1>::Zero();
    double square = 0;

    void add(const Eigen::Matrix<double, Terms, 1>& row, double u) {
        left += row * row.transpose();
        right += u * row;
        square += u * u;
    }
    void add(const regression_sums& other, double weight = 1) {
        left += weight * other.left;
        right += weight * other.right;
        square += weight * other.square;
    }
    /// Coefficients without the first `skipped` terms, and what they leave of the square.
    std::pair<Eigen::VectorXd, double> solved(int skipped = 0) const {
        const int n = Terms - skipped;
        Eigen::MatrixXd m = left.bottomRightCorner(n, n);
        for (int i = 0; i < n; ++i) m(i, i) += 1e-9 * std::max(m(i, i), 1e-300) + 1e-300;
        const Eigen::VectorXd b = right.tail(n), x = m.ldlt().solve(b);
        return {x, std::max(0.0, square - x.dot(b))};
    }
};

/// Terms of the command besides the acceleration: speed, direction, a constant, the position, and its sine and
/// cosine where it is an angle (gravity).
inline constexpr int unit_terms = 7;
using unit_sums = regression_sums<unit_terms>;

inline void solve_units(unit_check& out, const std::vector<unit_sums>& stretches) {
    unit_sums all;
    for (const auto& s : stretches) all.add(s);
    const auto [with, left] = all.solved();
    const double left_without = all.solved(1).second;
    const double mean = all.right[3] / std::max(1.0, all.left(3, 3));
    const double variance = all.square - mean * all.right[3];
    out.command_per_acceleration = with[0] / out.peak_acceleration;
    out.share = variance > 0 ? (left_without - left) / variance : 0;
    out.share_of_left = left_without > 0 ? (left_without - left) / left_without : 0;
    double sum = 0; // jackknife over the stretches
    for (const auto& s : stretches) {
        unit_sums rest = all;
        rest.add(s, -1);
        const double d = rest.solved().first[0] / out.peak_acceleration - out.command_per_acceleration;
        sum += d * d;
    }
    const auto n = static_cast<double>(stretches.size());
    out.spread = std::sqrt(sum * (n - 1) / n);
}

/// Terms of the same regression with speed and direction first and the jerk beside the acceleration: a command
/// that comes earlier than the reading moves a part of the inertia into the speed, and the jerk takes it back.
inline constexpr int friction_terms = 8;
using friction_sums = regression_sums<friction_terms>;

inline void solve_friction(unit_check& out, const std::vector<friction_sums>& stretches) {
    friction_sums all;
    for (const auto& s : stretches) all.add(s);
    const auto taken = [](const friction_sums& s) {
        const auto moving = s.left(1, 1); // rows that move; the speed times the direction is its size
        const auto x = s.solved().first;
        return moving > 0 ? x[0] * s.left(0, 1) / moving + x[1] : 0.0;
    };
    const double left = all.solved().second, left_without = all.solved(2).second;
    const double mean = all.right[4] / std::max(1.0, all.left(4, 4));
    const double variance = all.square - mean * all.right[4];
    out.friction = taken(all);
    out.friction_share = variance > 0 ? (left_without - left) / variance : 0;
    double sum = 0; // jackknife over the stretches
    for (const auto& s : stretches) {
        friction_sums rest = all;
        rest.add(s, -1);
        const double d = taken(rest) - out.friction;
        sum += d * d;
    }
    const auto n = static_cast<double>(stretches.size());
    out.friction_spread = std::sqrt(sum * (n - 1) / n);
}

/// Slope and correlation of the position over the reference.
inline void compare_with_reference(unit_check& out, const axis_log& log) {
    const auto n = static_cast<double>(log.position.size());
    double mean_r = 0, mean_y = 0, rr = 0, ry = 0, yy = 0;
    for (std::size_t k = 0; k < log.position.size(); ++k) {
        mean_r += log.reference[k] / n;
        mean_y += log.position[k] / n;
    }
    for (std::size_t k = 0; k < log.position.size(); ++k) {
        const double r = log.reference[k] - mean_r, y = log.position[k] - mean_y;
        rr += r * r;
        ry += r * y;
        yy += y * y;
    }
    out.position_per_reference = rr > 0 ? ry / rr : 0;
    out.correlation = rr > 0 && yy > 0 ? ry / std::sqrt(rr * yy) : 0;
}

/// `v`: velocity of the position, below the corner.
inline void compare_with_velocity(unit_check& out, const axis_log& log, double period,
                                  const std::vector<double>& v) {
    if (log.velocity.size() != v.size()) return;
    const auto w = zero_phase(log.velocity, out.corner_Hz, period);
    double vv = 0, vw = 0, ww = 0;
    for (std::size_t k = 0; k < v.size(); ++k) {
        if (!log.left_out.empty() && log.left_out[k]) continue;
        vv += v[k] * v[k];
        vw += v[k] * w[k];
        ww += w[k] * w[k];
    }
    if (!(vv > 0) || !(ww > 0)) return;
    out.velocity_per_position = vw / vv;
    out.velocity_correlation = vw / std::sqrt(vv * ww);
}

} // namespace detail

/// Regression of the command over acceleration, speed, direction and position, and of the position over the
/// reference. A controller that fights friction or gravity may push against the acceleration for a while:
/// spread and share say how sure the sign is.
inline unit_check check_units(const axis_log& log, double period) {
    using namespace detail;
    unit_check out;
    const auto n = log.position.size();
    const auto [low, high] = std::minmax_element(log.position.begin(), log.position.end());
    out.travel = *high - *low;
    compare_with_reference(out, log);
    out.spread = std::numeric_limits<double>::infinity();
    if (!(out.travel > 0) || n < 64) return out;
    out.corner_Hz = motion_corner(log.position, period, observed_count(log.position, log.position_step));
    const auto x = zero_phase(log.position, out.corner_Hz, period), v = derivative(x, period),
               a = derivative(v, period), j = derivative(a, period),
               u = zero_phase(log.command, out.corner_Hz, period);
    compare_with_velocity(out, log, period, v);
    for (std::size_t k = 0; k < n; ++k) {
        if (!log.left_out.empty() && log.left_out[k]) continue;
        out.peak_speed = std::max(out.peak_speed, std::abs(v[k]));
        out.peak_acceleration = std::max(out.peak_acceleration, std::abs(a[k]));
    }
    const auto rows = std::max<std::size_t>(8, static_cast<std::size_t>(15 / (out.corner_Hz * period)));
    constexpr std::size_t least = 6;
    const std::size_t stretch = std::min(rows, n / least), stretches = n / stretch;
    if (!(out.peak_acceleration > 0) || stretch < 8) return out;
    std::vector<unit_sums> sums(stretches);
    std::vector<friction_sums> friction(stretches);
    const double jerk = out.peak_acceleration * 2 * std::numbers::pi * out.corner_Hz;
    for (std::size_t k = 0; k < stretches * stretch; ++k) {
        if (!log.left_out.empty() && log.left_out[k]) continue;
        const double direction = std::abs(v[k]) > 0.01 * out.peak_speed ? (v[k] > 0 ? 1 : -1) : 0;
        const double angle = log.kind == axis_kind::rotary ? x[k] : 0;
        Eigen::Matrix<double, unit_terms, 1> row;
        row << a[k] / out.peak_acceleration, v[k] / out.peak_speed, direction, 1, (x[k] - *low) / out.travel,
            std::sin(angle), log.kind == axis_kind::rotary ? std::cos(angle) : 0;
        sums[k / stretch].add(row, u[k]);
        Eigen::Matrix<double, friction_terms, 1> moved;
        moved << row[1], row[2], row[0], j[k] / jerk, row[3], row[4], row[5], row[6];
        friction[k / stretch].add(moved, u[k]);
    }
    solve_units(out, sums);
    solve_friction(out, friction);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
