// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::diagnosis::suspect {

/// The drive clips below the limit that the controller knows. Joins the actuator. Shows only while the command is large: the
/// axis gets less than it was told, always the same force.
inline constexpr effect actuator_saturation{
    .name = "actuator_saturation",
    .box = "actuator",
    .exciting_motion = "the strongest acceleration that the program uses, and half of it",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double most = detail::largest_command(s);
        if (!(most > 0)) return {};
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.drive_limit; };
        return {{{.key = "actuator.drive_limit_V",
                  .of = of,
                  .start = detail::best_start(
                      s, of,
                      {0.97 * most, 0.9 * most, 0.8 * most, 0.65 * most, 0.5 * most, 0.35 * most, 0.2 * most}),
                  .low = 0.05 * most,
                  .high = most,
                  .logarithmic = true,
                  .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.drive_limit_V", {p.drive_limit}}};
    }};

} // namespace quadrant::diagnosis::suspect
