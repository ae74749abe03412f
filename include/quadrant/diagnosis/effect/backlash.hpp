// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// Play between the motor and the encoder on the load: the reading stands still until the motor has crossed it. Joins the
/// position. Shows at each reversal as a pause of the reading at full command, as long as the play is wide. A direct drive
/// cannot have it: name it in excluded_effects.
inline constexpr effect backlash{.name = "backlash",
                                 .box = "mechanics",
                                 .exciting_motion = "slow reversals of 0.1 mm and more, with rest before each",
                                 .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
                                     double& (*const of)(plant_model&) = [](plant_model& p) -> double& {
                                         return p.backlash;
                                     };
                                     const double count = s.record.resolution, travel = s.record.scale.travel;
                                     std::vector<double> ladder;
                                     for (double share : {5e-6, 1.5e-5, 5e-5, 1.5e-4, 5e-4})
                                         ladder.push_back(std::max(share * travel, 2 * count));
                                     return {{{.key = "backlash_m",
                                               .of = of,
                                               .start = detail::best_start(s, of, ladder),
                                               .low = count,
                                               .high = std::max(5e-3 * travel, 40 * count),
                                               .logarithmic = true,
                                               .step = 1e-2}}};
                                 },
                                 .read = [](const plant_model& p) -> std::vector<key_value> {
                                     return {{"backlash_m", {p.backlash}}};
                                 }};

} // namespace quadrant::diagnosis::suspect
