// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"

namespace quadrant::diagnosis {

/// A model as it runs in another log. A process that turns has no memory of the first log: where in its cycle the other
/// one begins is found again, everything else stays as fitted. Costs some forty passes, when there is a process at all.
inline plant_model restarted(plant_model plant, const axis_record& record) {
    if (plant.cutting.count == 0) return plant;
    const fitter fit(record.observer, record.score);
    double& (*const start)(plant_model&) = [](plant_model& p) -> double& { return p.cutting_start; };
    fit_result best;
    constexpr int tries = 24; // six a cycle of the fourth harmonic
    for (int i = 0; i < tries; ++i) {
        fit_result trial{.plant = plant, .x = Eigen::VectorXd(0)};
        start(trial.plant) = plant.cutting.period * i / tries;
        fit.evaluate(trial);
        if (trial.objective < best.objective) best = std::move(trial);
    }
    const double period = plant.cutting.period;
    return fit
        .fit(best.plant,
             {{.key = "process",
               .of = start,
               .start = start(best.plant),
               .low = -period,
               .high = 2 * period,
               .step = 1e-4 * period}},
             6)
        .plant;
}

} // namespace quadrant::diagnosis
