// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// The command acts later (or earlier) than described: u(t - delay). Joins the actuator. Shows as a phase that grows
/// with frequency while the amplitude stays.
inline constexpr effect time_delay{
    .name = "time_delay",
    .box = "actuator",
    .exciting_motion = "multi-sine of 20 to 200 Hz, or sharp starts and stops",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double t = s.record.period;
        std::vector<std::vector<parameter>> out;
        for (double extra :
             {0.1, 2.0}) // below and above the period: the delay moves the residual in steps of rows
            out.push_back({{.key = "delay_s",
                            .of = [](plant_model& p) -> double& { return p.delay; },
                            .start = s.leader.delay + extra * t,
                            .low = 0,
                            .high = s.leader.delay + 20 * t,
                            .step = 0.02 * t}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"delay_s", {p.delay}}};
    }};

} // namespace quadrant::diagnosis::suspect
