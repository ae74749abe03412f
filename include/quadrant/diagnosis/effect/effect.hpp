// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"
#include "effect_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What an effect may look at to choose its start values: the machine file, the best model so far and the force
/// that this model leaves.
struct screening {
    const plant_description& described;
    const tolerance_description& tolerance;
    const axis_record& record;
    const plant_model& leader;
    const std::vector<double>& residual;   ///< [N], sign of residual_force()
    const std::vector<double>& innovation; ///< of the leader [m]

    /// Force of the largest command, the scale of forces on this axis [N].
    double force_scale() const { return leader.force_constant * record.scale.command; }
    /// How far a number of an effect is searched. Behind closed loops the residual force says little of its
    /// size: a servo that its friction holds begins far too low, and what resists there, the motor moves.
    double farthest(double usual, double motor_moves) const {
        return record.closed() ? std::max(usual, motor_moves) : usual;
    }
    /// Where the search of a number that is never negative begins, which is `known` and seems to be `seen`
    /// larger, at `least`. Behind a drive's loops that says its size only: what a delay or a gain leaves there
    /// has any sign, and hides it.
    std::vector<double> beginnings(double known, double seen, double least = 0) const {
        std::vector<double> out{std::max(known + seen, least)};
        if (record.replayed() && seen < 0) out.push_back(known - seen);
        std::erase_if(out, [](double x) { return !(x > 0); });
        return out;
    }
};

namespace detail {

/// Mean residual over the rows that `chosen` picks; 0 when there are none.
template <class Chosen> double mean_residual(const screening& s, Chosen chosen) {
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < s.residual.size(); ++k)
        if (chosen(k)) {
            sum += s.residual[k];
            ++count;
        }
    return count > 0 ? sum / count : 0;
}

/// A machine value that is known to a tolerance may move freely: between a quarter and four times.
inline parameter freed(const char* key, double& (*of)(plant_model&), double value) {
    return {.key = key,
            .of = of,
            .start = value,
            .low = value / 4,
            .high = value * 4,
            .logarithmic = true,
            .step = 1e-3};
}

/// The value from which a fit begins, of those that may be tried: where the gradient sees nothing (a dead zone,
/// a limit, a play) only looking helps. Each costs one pass over the log.
inline double best_start(const screening& s, double& (*of)(plant_model&), const std::vector<double>& values) {
    std::vector<plant_model> plants(values.size(), s.leader);
    for (std::size_t i = 0; i < values.size(); ++i) of(plants[i]) = values[i];
    const auto looks = fitter(s.record.observer, s.record.score).objectives(plants);
    return values[static_cast<std::size_t>(std::min_element(looks.begin(), looks.end()) - looks.begin())];
}

/// Where the fit of a limit begins: the best of several shares of the largest value that the record shows. No
/// slope leads to a limit that clips nothing.
/// `lowest`: share of that value below which no limit is looked for.
inline parameter limit_below(const screening& s, const char* key, double& (*of)(plant_model&), double most,
                             double lowest = 0.05,
                             std::vector<double> starts = {0.97, 0.9, 0.8, 0.65, 0.5, 0.35, 0.2}) {
    for (double& start : starts) start *= most;
    return {.key = key,
            .of = of,
            .start = best_start(s, of, starts),
            .low = lowest * most,
            .high = most,
            .logarithmic = true,
            .step = 1e-2};
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
