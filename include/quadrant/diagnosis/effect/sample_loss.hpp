// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// In some periods the drive keeps the previous command: a bus telegram that came too late. Joins the actuator. Shows as
/// pulses whose size is what the command changed by in that period; see sample_loss.hpp for how they are found. Its
/// probability is counted where a loss would stand out of the noise, by expectation and maximisation. A
/// lost command leaves a pulse of known sign: what merely looks like pulses, at reversals say, has either.
inline constexpr effect sample_loss{
    .name = "sample_loss",
    .box = "actuator",
    .exciting_motion = "multi-sine of 50 to 200 Hz: the command must change much in each period",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        plant_model plant = s.leader;
        plant.loss = 0;
        std::vector<double> innovation;
        s.record.observer.run(plant, innovation);
        double p = 0.05;
        lossy_commands found;
        for (int round = 0; round < 4; ++round) {
            found = s.record.observer.commands_with_loss(plant, innovation, p);
            if (found.told < 50) return {};
            p = std::clamp(found.lost / found.told, 1e-3, 0.5);
        }
        // Five times the scatter: in a closed loop the sensor's noise is in the command and in the pulses.
        const double net = found.lost - found.mirrored, scatter = std::sqrt(found.lost + found.mirrored);
        if (net < 5 || net < 5 * scatter) return {};
        if (p > 0.2) return {}; // no drive runs like that: something else makes the pulses
        p = std::clamp(net / found.told, 1e-3, 0.5);
        return {{{.key = "actuator.loss_probability",
                  .of = [](plant_model& q) -> double& { return q.loss; },
                  .start = p,
                  .low = p / 1.5,
                  .high = 1.5 * p,
                  .logarithmic = true,
                  .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.loss_probability", {p.loss}}};
    }};

} // namespace quadrant::diagnosis::suspect
