// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// In some periods the drive keeps the previous command: a bus telegram that came too late. Joins the actuator. Shows as
/// pulses whose size is what the command changed by in that period; see sample_loss.hpp for how they are found.
inline constexpr effect sample_loss{
    .name = "sample_loss",
    .box = "actuator",
    .exciting_motion = "multi-sine of 50 to 200 Hz: the command must change much in each period",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.loss; };
        return {{{.key = "actuator.loss_probability",
                  .of = of,
                  .start = detail::best_start(s, of, {0.005, 0.02, 0.06, 0.12, 0.2, 0.35}),
                  .low = 1e-3,
                  .high = 0.6,
                  .logarithmic = true,
                  .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.loss_probability", {p.loss}}};
    }};

} // namespace quadrant::diagnosis::suspect
