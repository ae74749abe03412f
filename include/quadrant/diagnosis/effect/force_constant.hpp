// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// F = kf u with another kf than described. Joins the actuator gain. Scales whatever the command does: acceleration,
/// and also what balances friction and offset.
inline constexpr effect force_constant{
    .name = "force_constant",
    .box = "actuator",
    .exciting_motion = "strong accelerations beside slow strokes against known friction, or a known load",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        return {{detail::freed(
            "force_constant_N_per_V", [](plant_model& p) -> double& { return p.force_constant; },
            s.leader.force_constant)}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"force_constant_N_per_V", {p.force_constant}}};
    }};

} // namespace quadrant::diagnosis::suspect
