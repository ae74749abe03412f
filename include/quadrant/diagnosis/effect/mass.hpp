// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// M dv/dt with another M than described. Joins the inertia. Shows as a residual proportional to the acceleration,
/// and only there: friction and offset keep their size, which is what tells it from the force constant.
inline constexpr effect mass{
    .name = "mass",
    .box = "mechanics",
    .exciting_motion = "strong accelerations beside slow strokes against friction",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        return {{detail::freed(
            "mass_kg", [](plant_model& p) -> double& { return p.mass; }, s.leader.mass)}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"mass_kg", {p.mass}}};
    }};

} // namespace quadrant::diagnosis::suspect
