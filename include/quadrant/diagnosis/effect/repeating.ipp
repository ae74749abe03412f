// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Dense>
#include <complex>

namespace quadrant::inline v0::diagnosis::detail {

QUADRANT_DIAGNOSIS_DECL bool holds_more_than_three(const screening& s, double period) {
    constexpr Eigen::Index count = harmonics::most, numbers = 2 * count + 1;
    Eigen::Matrix<double, numbers, numbers> squares = Eigen::Matrix<double, numbers, numbers>::Zero();
    Eigen::Vector<double, numbers> with_force = Eigen::Vector<double, numbers>::Zero(), row;
    double rows = 0, energy = 0;
    for (std::size_t k = s.record.score.skip; k < s.residual.size(); ++k) {
        const auto turn = std::polar(1.0, 2 * std::numbers::pi * s.record.position[k] / period);
        auto phasor = turn;
        for (Eigen::Index i = 0; i < count; ++i, phasor *= turn)
            row.segment<2>(2 * i) << phasor.real(), phasor.imag();
        row[2 * count] = 1;
        squares += row * row.transpose();
        with_force += s.residual[k] * row;
        energy += s.residual[k] * s.residual[k];
        ++rows;
    }
    const Eigen::Vector<double, numbers> size = squares.ldlt().solve(with_force);
    const double left = std::max(0.0, energy - size.dot(with_force)) / rows;
    const double denser = std::max(1.0, 0.5 / (s.record.bandwidth_Hz * s.record.period));
    const double by_noise = 4 * left * denser / rows;
    for (Eigen::Index i = 3; i < count; ++i)
        if (size.segment<2>(2 * i).squaredNorm() > 10 * by_noise) return true;
    return false;
}

} // namespace quadrant::inline v0::diagnosis::detail
