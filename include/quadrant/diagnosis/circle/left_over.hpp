// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../analysis/circle_fit.hpp"
#include "cyclic.hpp"
#include "vibration.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// G of a run and the centre of the circle fitted to it.
inline circle_run_result measured(const circle_run& run, const std::vector<double>& left) {
    circle_run_result out;
    out.run = run;
    std::vector<double> x, y;
    for (std::size_t k = 0; k < run.angle.size(); ++k) {
        const double r = run.radius + run.deviation[k];
        x.push_back(r * std::cos(run.angle[k])), y.push_back(r * std::sin(run.angle[k]));
    }
    const auto fitted = analysis::detail::fit_circle(x, y, {0, 0, run.radius});
    out.circular_error = analysis::detail::least_range(x, y, fitted[0], fitted[1]);
    out.centre_x = fitted[0], out.centre_y = fitted[1];
    const bool about_fitted = run.source == circle_source::instrument;
    out.radial_max = -HUGE_VAL, out.radial_min = HUGE_VAL;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double d =
            about_fitted ? std::hypot(x[k] - fitted[0], y[k] - fitted[1]) - run.radius : run.deviation[k];
        out.radial_max = std::max(out.radial_max, d), out.radial_min = std::min(out.radial_min, d);
        out.remaining += left[k] * left[k] / double(x.size());
        out.model.push_back(run.deviation[k] - left[k]);
    }
    out.remaining = std::sqrt(out.remaining);
    return out;
}

/// What is periodic in what is left, the strongest first; each is taken out of `left` and of `runs` before the
/// next is sought.
inline std::vector<periodic_error> take_periodic(std::vector<circle_run>& runs, residuals& left,
                                                 const std::vector<std::size_t>& groups, double shortest,
                                                 double floor, std::array<double, 3>& limits) {
    std::vector<periodic_error> found;
    std::array<bool, 3> taken{};
    for (std::size_t round = 0; round < 4; ++round) {
        const cyclic_search along(runs, left, shortest);
        const vibration_search in_time(runs, left, groups);
        const std::array sought{along(0), along(1), in_time()};
        std::size_t best = 3;
        for (std::size_t k = 0; k < 3; ++k) {
            limits[k] = std::max(sought[k].threshold, floor);
            const double most = sought[k].amplitude.empty()
                                    ? 0
                                    : *std::max_element(sought[k].amplitude.begin(), sought[k].amplitude.end());
            if (sought[k].there && most > limits[k] && !taken[k] &&
                (best == 3 || sought[k].energy > sought[best].energy))
                best = k;
        }
        if (best == 3) break;
        taken[best] = true;
        found.push_back(sought[best]);
        if (best == 2) found.back().axis += 10; // in time
        for (std::size_t j = 0; j < runs.size(); ++j) {
            const auto tone = best == 2 ? in_time.in(j, sought[2].period) : std::vector<double>{};
            for (std::size_t k = 0; k < left[j].size(); ++k) {
                const double e =
                    best == 2 ? tone[k] : cyclic_search::at(sought[best], j, runs[j].radius, runs[j].angle[k]);
                left[j][k] -= e, runs[j].deviation[k] -= e;
            }
        }
    }
    return found;
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
