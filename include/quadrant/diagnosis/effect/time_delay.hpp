// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// The command acts later (or earlier) than described: u(t - delay). Joins the actuator. Shows as a phase that grows
/// with frequency while the amplitude stays.
inline constexpr effect time_delay{.name = "time_delay",
                                   .box = "actuator",
                                   .exciting_motion = "multi-sine of 20 to 200 Hz, or sharp starts and stops",
                                   .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
                                       const double t = s.record.period;
                                       std::vector<std::vector<parameter>> out;
                                       // Inside one period, and one to which the loop responds.
                                       for (double extra : {0.1 * t, 0.4 * s.record.scale.response()})
                                           out.push_back(
                                               {{.key = "delay_s",
                                                 .of = [](plant_model& p) -> double& { return p.delay; },
                                                 .start = s.leader.delay + extra,
                                                 .low = 0,
                                                 .high = s.leader.delay + 4 * s.record.scale.response(),
                                                 .step = 0.02 * t}});
                                       return out;
                                   },
                                   .read = [](const plant_model& p) -> std::vector<key_value> {
                                       return {{"delay_s", {p.delay}}};
                                   }};

} // namespace quadrant::diagnosis::suspect
