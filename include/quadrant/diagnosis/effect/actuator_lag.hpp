// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// A current loop of first order, 1/(lag s + 1), behind the command. Joins the actuator. Shows as a phase that bends and an
/// amplitude that falls with frequency, where a delay keeps the amplitude.
inline constexpr effect actuator_lag{
    .name = "actuator_lag",
    .box = "actuator",
    .exciting_motion = "multi-sine of 20 to 300 Hz, or sharp starts and stops",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double t = s.record.scale.response();
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.lag; };
        return {{{.key = "actuator.lag_s",
                  .of = of,
                  .start = detail::best_start(s, of, {0.06 * t, 0.2 * t, 0.6 * t, 1.6 * t}),
                  .low = 0.01 * t,
                  .high = 10 * t,
                  .logarithmic = true,
                  .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.lag_s", {p.lag}}};
    }};

} // namespace quadrant::diagnosis::suspect
