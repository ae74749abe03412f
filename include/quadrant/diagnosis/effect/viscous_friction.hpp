// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// F = B v with another B than described. Joins the force, in the friction box. Shows as a residual
/// proportional to the velocity.
inline constexpr effect viscous_friction{
    .name = "viscous_friction",
    .label = "viscous friction",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "constant speeds, slow and fast, in both directions",
    .everyday = true,
    .of_speed = true,
    .shows = "proportional to velocity",
    .keys = {machine_key{.name = "viscous_N_s_per_m",
                         .rule = detail::rule::not_negative,
                         .meaning = "friction force for each m/s",
                         .at = member<&plant_description::viscous_N_s_per_m>,
                         .tolerance = true}},
    .prior = {0.7, "oil changes with temperature and age, so the value in a file is seldom today's"},
    .compensation = "the key viscous_feedforward_V_s_per_m",
    .remedy =
        "Set the viscous feedforward to the value found; if it has grown, check grease, oil and temperature.",
    .trial = {.low = 0.02,
              .high = 20,
              .into =
                  [](trial_machine& m) {
                      m.set("viscous_N_s_per_m", m.changed(m.now("viscous_N_s_per_m"), 0.7));
                  },
              .slow_shows_it = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        double vv = 0, vf = 0;
        for (std::size_t k = 0; k < s.residual.size(); ++k) {
            vv += s.record.velocity[k] * s.record.velocity[k];
            vf += s.record.velocity[k] * s.residual[k];
        }
        const double b = s.leader.friction.viscous_slope, speed = s.record.scale.speed;
        const double least = std::max(0.25 * b, 1e-5 * s.force_scale() / speed);
        std::vector<std::vector<parameter>> out;
        for (const double start : s.beginnings(b, vv > 0 ? vf / vv : 0, least))
            out.push_back({{.key = "viscous_N_s_per_m",
                            .of = [](plant_model& p) -> double& { return p.friction.viscous_slope; },
                            .start = start,
                            .low = 0.01 * start,
                            .high = s.farthest(20 * start, s.force_scale() / speed),
                            .logarithmic = true,
                            .step = 1e-3}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"viscous_N_s_per_m", {p.friction.viscous_slope}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
