// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"
#include "calibration.hpp"

namespace quadrant::inline v0::diagnosis {

/// A model as it runs in another log. A process that turns has no memory of the first log: where in its cycle
/// the other one begins is found again, everything else stays as fitted. Costs some forty passes, when there is
/// a process at all. Of a drive, the force that its integral holds at the first row and the moments at which
/// its registers were read are found again, and which set-points it lost; what happened in the first record did
/// not happen here.
inline plant_model restarted(plant_model plant, const axis_record& record) {
    plant.drive.off_from = plant.drive.off_until = 0;
    // First: the fits below need them, and where the integral stands makes no pulse.
    if (plant.drive.losses_known()) plant.drive.received = record.observer.received(plant);
    if (plant.drive.has_integral()) {
        const fitter fit(record.observer, record.score);
        // What a drive at rest holds; or what it held in the first log, of a force that no model has.
        std::vector<plant_model> begun(2, plant);
        begun[0].drive.start_force = plant.holding_force(record.position[0]);
        const auto left = fit.objectives(begun);
        plant = begun[left[1] < left[0] ? 1 : 0];
        // What drifts says nothing of where it began.
        if (record.observer.drift_pole == 1)
            plant = fit.fit(plant, {start_of_drive(plant.force_constant * record.scale.command)}, 4).plant;
    }
    if (plant.drive.reads_in_turn() && record.observer.drive && record.observer.drive->tapped()) {
        plant.drive.read = record.read;
        plant = fitter(record.observer, record.score)
                    .fit(plant, timing_of_readings(plant.drive, record.period), 4)
                    .plant;
    }
    if (plant.cutting.count == 0) return plant;
    const fitter fit(record.observer, record.score);
    double& (*const start)(plant_model&) = [](plant_model& p) -> double& { return p.cutting_start; };
    constexpr std::size_t tries = 24; // six a cycle of the fourth harmonic
    std::vector<plant_model> plants(tries, plant);
    for (std::size_t i = 0; i < tries; ++i)
        start(plants[i]) = plant.cutting.period * static_cast<double>(i) / static_cast<double>(tries);
    const auto looks = fit.objectives(plants);
    plant_model& best =
        plants[static_cast<std::size_t>(std::min_element(looks.begin(), looks.end()) - looks.begin())];
    const double period = plant.cutting.period;
    return fit
        .fit(best,
             {{.key = "process",
               .of = start,
               .start = start(best),
               .low = -period,
               .high = 2 * period,
               .step = 1e-4 * period}},
             6)
        .plant;
}

} // namespace quadrant::inline v0::diagnosis
