// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "fit_circles.hpp"

#include <array>

namespace quadrant::inline v0::diagnosis::detail {

/// The shape of the spikes of one axis in one group of runs: of a grid of rises, decays (0.3 to 25 degrees) and
/// orders the one that leaves least of the mean of all reversals, beside the step of a play and a cubic for the
/// form of the circle.
inline spike_shape fit_spike(const std::vector<circle_bin>& bins, const std::vector<std::size_t>& group_of_run,
                             std::size_t group, int axis, double passed) {
    constexpr double degree = std::numbers::pi / 180, before = 12 * degree, after = 40 * degree,
                     cell = 0.25 * degree;
    constexpr auto cells = static_cast<std::size_t>((before + after) / cell);
    std::array<double, cells> sum{}, step{}, count{};
    const circle_pattern play = backlash_pattern(axis, passed);
    for (const circle_bin& b : bins) {
        if (group_of_run[b.at.run] != group) continue;
        double since = reversed(b.at, axis).angle;
        if (since > std::numbers::pi - before) since -= std::numbers::pi;
        if (since >= after) continue;
        const auto at = static_cast<std::size_t>(std::clamp((since + before) / cell, 0.0, double(cells - 1)));
        sum[at] += b.deviation, step[at] += play.of(b.at), ++count[at];
    }
    std::vector<std::size_t> there;
    for (std::size_t k = 0; k < cells; ++k)
        if (count[k] > 0) there.push_back(k);
    spike_shape best;
    const auto n = static_cast<Eigen::Index>(there.size());
    if (n < 20) return best;
    Eigen::MatrixXd form(n, 5);
    Eigen::VectorXd mean(n), since(n), spike(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const std::size_t k = there[static_cast<std::size_t>(i)];
        since(i) = (double(k) + 0.5) * cell - before, mean(i) = sum[k] / count[k];
        for (int power = 0; power < 4; ++power) form(i, power) = std::pow(since(i) / after, power);
        form(i, 4) = step[k] / count[k];
    }
    for (Eigen::Index c = 0; c < 5; ++c) { // orthonormal, and the mean without them
        for (Eigen::Index other = 0; other < c; ++other)
            form.col(c) -= form.col(other).dot(form.col(c)) * form.col(other);
        form.col(c) /= std::max(form.col(c).norm(), 1e-12);
        mean -= form.col(c).dot(mean) * form.col(c);
    }
    double most = 0;
    for (const int order : {1, 2, 4})
        for (double decay = 0.3 * degree; decay < 25 * degree; decay *= 1.35)
            for (const double rise : {0.05, 0.15, 0.4, 1.0}) {
                const spike_shape shape{rise * decay, decay, order};
                for (Eigen::Index i = 0; i < n; ++i) spike(i) = shape(since(i));
                const double whole = spike.squaredNorm(), along = spike.dot(mean);
                double own = whole;
                for (Eigen::Index c = 0; c < 5; ++c) own -= std::pow(form.col(c).dot(spike), 2);
                const double taken = own > 1e-3 * whole ? along * along / own : 0;
                if (taken > most) most = taken, best = shape;
            }
    return best;
}

} // namespace quadrant::inline v0::diagnosis::detail
