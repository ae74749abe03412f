// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../rules.hpp"
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// In some periods the drive keeps the previous command: a bus telegram that came too late. Joins the actuator. Shows as
/// pulses as large as what the command changed by in that period; see sample_loss.hpp for how they are found. A suspect when
/// they speak for a loss clearly more than for pulses of half or twice the size or turned over, and not in a few
/// places only: losses know nothing of the motion.
inline constexpr effect sample_loss{
    .name = "sample_loss",
    .box = "actuator",
    .exciting_motion = "multi-sine of 50 to 200 Hz: the command must change much in each period",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        plant_model plant = s.leader;
        plant.loss = 0;
        std::vector<double> innovation;
        s.record.observer.run(plant, innovation);
        const auto with = [&](double size) {
            return s.record.observer.commands_with_loss(plant, innovation, {.learned = true, .size = size});
        };
        const lossy_commands found = with(1);
        const double p = found.probability, enough = rules{}.margin;
        // Above a quarter no drive runs: something else makes the pulses.
        if (found.told < 50 || p > 0.25 || found.gain < enough || found.gain_elsewhere < enough) return {};
        for (double other : {-1.0, 0.5, 2.0})
            if (found.gain - with(other).gain < enough) return {};
        return {{{.key = "actuator.loss_probability",
                  .of = [](plant_model& q) -> double& { return q.loss; },
                  .start = p,
                  .low = p / 2,
                  .high = 2 * p,
                  .logarithmic = true,
                  .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.loss_probability", {p.loss}}};
    }};

} // namespace quadrant::diagnosis::suspect
