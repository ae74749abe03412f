// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadrant::inline v0::diagnosis::chain {

/// How steep the part of an error along the travel can be that one column has; 0: it has none.
inline double steepest_of(const readings& r, const fitted& f, std::size_t column) {
    const auto first =
        static_cast<std::size_t>(std::find(f.of.begin(), f.of.end(), f.of[column]) - f.of.begin());
    const std::size_t nth = column - first;
    const auto i = static_cast<double>(nth);
    const double size = std::abs(f.values[static_cast<Eigen::Index>(column)]);
    if (f.of[column] == term::smooth) return size * (i + 2) * (i + 3) / r.travel(); // at the ends
    if (f.of[column] != term::pitch && f.of[column] != term::cyclic) return 0;
    const double period = f.of[column] == term::pitch ? f.model.pitch_period : f.model.cyclic_period;
    // Of a sine and a cosine beside each other the larger one, at least.
    const std::size_t beside = nth % 2 == 0 ? column + 1 : column - 1;
    const double other = std::abs(f.values[static_cast<Eigen::Index>(beside)]);
    return size < other ? 0 : 2 * std::numbers::pi * (std::floor(i / 2) + 1) * size / period;
}

/// Whether a model can be: no play is narrower than nothing, no spring gives way against its load, no friction
/// drives the motor, no error along the travel turns the load back, and no lag is a tenth of the record. A fit
/// that needs such a value imitates another term.
inline bool possible(const readings& r, const fitted& f) {
    const link_model& m = f.model;
    constexpr double sure = 3; // deviations
    double play = m.play, compliance = m.compliance, friction = 0, narrowest = 0, deviation = 0;
    double steepest = 0; // of errors along the travel, at most: from 1 on load or reading may turn back
    for (std::size_t j = 0; j < f.of.size(); ++j) {
        const auto i = static_cast<Eigen::Index>(j);
        const double value = f.values[i];
        if (f.of[j] == term::play && f.of[j - 1] != term::play) {
            play += value;
            const double along = f.values[i + 1], turned = along > 0 ? -1 : 1;
            narrowest = play - std::abs(along); // at one end of the travel
            deviation = std::sqrt(std::max(0.0, f.covariance(i, i) + f.covariance(i + 1, i + 1) +
                                                    2 * turned * f.covariance(i, i + 1)));
        }
        if (f.of[j] == term::spring) compliance += value;
        if (f.of[j] == term::motor_friction) friction += value;
        steepest += steepest_of(r, f, j);
    }
    friction += m.motor_coulomb * compliance;
    // Nor does anything follow so late that the record holds hardly any of it.
    const double longest = 0.1 * r.of().period * static_cast<double>(r.of().rows());
    const auto follows = [&](term t) { return !m.has(t) || m.late(t) < longest; };
    return steepest < 1 && follows(term::delay) && follows(term::first_order) &&
           !(m.has(term::play) && (play <= 0 || narrowest < -sure * deviation)) &&
           !(m.has(term::spring) && compliance <= 0) && !(m.has(term::motor_friction) && friction < 0);
}

} // namespace quadrant::inline v0::diagnosis::chain
