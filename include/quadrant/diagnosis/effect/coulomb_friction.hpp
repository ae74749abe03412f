// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// F = Fc sign(v), stick at rest [Armstrong1994]. Joins the force, in the friction box. Shows as a residual
/// that jumps with the direction and does not change with speed.
inline constexpr effect coulomb_friction{
    .name = "coulomb_friction",
    .label = "Coulomb friction",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "slow strokes in both directions at two constant speeds",
    .everyday = true,
    .shows = "a jump with the direction",
    .keys = {machine_key{.name = "coulomb_N",
                         .rule = detail::rule::not_negative,
                         .meaning =
                             "level of friction that does not change with the speed; the axis sticks at rest",
                         .at = member<&plant_description::coulomb_N>,
                         .tolerance = true}},
    .prior = {1, "every guide and every seal has it; all other odds are against this one"},
    .compensation = "coulomb_feedforward_V, or the law over speed (friction_feedforward)",
    .remedy = "Feed the friction forward with the sign of the reference velocity; if its level has risen, look "
              "at lubrication, preload and seals.",
    .trial = {.low = 0.002,
              .high = 30,
              .into =
                  [](trial_machine& m) {
                      const double was = m.described("coulomb_N"); // 0: the machine file does not have it
                      m.set("coulomb_N", was == 0 ? m.amplitude * 0.01 * m.around.peak_force
                                                  : m.changed(m.now("coulomb_N")));
                  },
              .slow_shows_it = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double jump =
            0.5 * (detail::mean_residual(s, [&](std::size_t k) { return s.record.velocity[k] > 0; }) -
                   detail::mean_residual(s, [&](std::size_t k) { return s.record.velocity[k] < 0; }));
        const double scale = 1e-4 * s.force_scale(); // below every friction that matters to the command
        const double start =
            std::max({s.leader.friction.coulomb + jump, 0.3 * s.leader.friction.coulomb, scale});
        return {{{.key = "coulomb_N",
                  .of = [](plant_model& p) -> double& { return p.friction.coulomb; },
                  .start = start,
                  .low = std::min(0.1 * start, scale),
                  .high = 20 * start + 100 * scale,
                  .logarithmic = true,
                  .step = 1e-3}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"coulomb_N", {p.friction.coulomb}}};
    }};

} // namespace quadrant::diagnosis::suspect
