// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// M dv/dt with another M than described. Joins the inertia. Shows as a residual proportional to the
/// acceleration,
/// and only there: friction and offset keep their size, which is what distinguishes it from the force constant.
inline constexpr effect mass{
    .name = "mass",
    .label = "moving mass",
    .box = "mechanics",
    .joins = joint::force,
    .exciting_motion = "strong accelerations beside slow strokes against friction",
    .shows = "proportional to acceleration, and only there",
    .keys = {machine_key{.name = "mass_kg",
                         .rule = detail::rule::positive,
                         .meaning = "all that the motor accelerates",
                         .at = member<&plant_description::mass_kg>,
                         .required = true,
                         .tolerance = true}},
    .prior = {0.7, "workpieces and fixtures change it, and it is often only computed"},
    .compensation = "the key acceleration_feedforward_V_s2_per_m",
    .remedy = "Set the acceleration feedforward to the mass found; check which workpiece and fixture was on "
              "the axis.",
    .trial = {.low = 0.01,
              .high = 1.5,
              .into = [](trial_machine& m) { m.set("mass_kg", m.changed(m.now("mass_kg"), 0.7)); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        return {{detail::freed(
            "mass_kg", [](plant_model& p) -> double& { return p.mass; }, s.leader.mass)}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"mass_kg", {p.mass}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
