// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log.hpp"
#include "../signals.hpp"

#include <Eigen/Dense>

namespace quadrant::diagnosis {

/// What physics says of the units of one axis.
struct unit_check {
    double position_per_reference = 1; ///< slope of the position over the reference: 1 when both have one unit
    double travel = 0, peak_speed = 0, peak_acceleration = 0; ///< of the position, 20 Hz [m], [m/s], [m/s^2]
    double command_per_acceleration = 0;                      ///< of command = A a + B v + C sign v + D
    double spread = 0; ///< standard deviation of A, from motion segments of 0.25 s
    bool sign_is_known() const { return std::abs(command_per_acceleration) > 4 * spread; }
};

/// Regression of the command over acceleration, speed and direction, and of the position over the reference. A controller
/// that fights friction may still push against the acceleration for a while: the spread says how sure the sign is.
inline unit_check check_units(const axis_log& log, double period) {
    unit_check out;
    const auto n = log.position.size();
    const auto x = zero_phase(log.position, 20, period), v = derivative(x, period), a = derivative(v, period);
    const auto u = zero_phase(log.command, 20, period);
    const auto mean = [](const std::vector<double>& z) {
        double sum = 0;
        for (double e : z) sum += e;
        return sum / static_cast<double>(z.size());
    };
    const double mean_r = mean(log.reference), mean_y = mean(log.position);
    double rr = 0, ry = 0;
    for (std::size_t k = 0; k < n; ++k) {
        rr += (log.reference[k] - mean_r) * (log.reference[k] - mean_r);
        ry += (log.reference[k] - mean_r) * (log.position[k] - mean_y);
        out.peak_speed = std::max(out.peak_speed, std::abs(v[k]));
        out.peak_acceleration = std::max(out.peak_acceleration, std::abs(a[k]));
    }
    out.position_per_reference = rr > 0 ? ry / rr : 0;
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    out.travel = *high - *low;

    const auto rows = std::max<std::size_t>(8, static_cast<std::size_t>(0.25 / period));
    const std::size_t blocks = n / rows;
    if (blocks < 6 || !(out.peak_acceleration > 0)) {
        out.spread = std::numeric_limits<double>::infinity();
        return out;
    }
    std::vector<Eigen::Matrix4d> left(blocks, Eigen::Matrix4d::Zero());
    std::vector<Eigen::Vector4d> right(blocks, Eigen::Vector4d::Zero());
    for (std::size_t k = 0; k < blocks * rows; ++k) {
        const double direction = std::abs(v[k]) > 0.01 * out.peak_speed ? (v[k] > 0 ? 1 : -1) : 0;
        const Eigen::Vector4d row(a[k] / out.peak_acceleration, v[k] / out.peak_speed, direction, 1);
        left[k / rows] += row * row.transpose();
        right[k / rows] += u[k] * row;
    }
    const auto solved = [&](std::size_t without) {
        Eigen::Matrix4d m = 1e-9 * Eigen::Matrix4d::Identity();
        Eigen::Vector4d b = Eigen::Vector4d::Zero();
        for (std::size_t i = 0; i < blocks; ++i)
            if (i != without) {
                m += left[i];
                b += right[i];
            }
        return m.ldlt().solve(b)[0] / out.peak_acceleration;
    };
    out.command_per_acceleration = solved(blocks);
    double sum = 0; // jackknife over the segments
    for (std::size_t i = 0; i < blocks; ++i) {
        const double d = solved(i) - out.command_per_acceleration;
        sum += d * d;
    }
    out.spread = std::sqrt(sum * static_cast<double>(blocks - 1) / static_cast<double>(blocks));
    return out;
}

} // namespace quadrant::diagnosis
