// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// F = Fc sign(v), stick at rest [Armstrong1994]. Joins the force, in the friction box. Shows as a residual
/// that jumps with the direction and does not change with speed.
inline constexpr effect coulomb_friction{
    .name = "coulomb_friction",
    .label = "Coulomb friction",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "slow strokes in both directions at two constant speeds",
    .everyday = true,
    .of_speed = true,
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
        const auto forwards = [&](std::size_t k) { return s.record.velocity[k] > 0; };
        const auto backwards = [&](std::size_t k) { return s.record.velocity[k] < 0; };
        const double jump = 0.5 * (detail::mean_residual(s, forwards) - detail::mean_residual(s, backwards));
        // On a record that goes one way the few rows of the other say little: then what resists the motion.
        double resists = 0;
        for (std::size_t k = 0; k < s.residual.size(); ++k)
            resists += (forwards(k) ? 1 : backwards(k) ? -1 : 0) * s.residual[k] / double(s.residual.size());
        const double scale = 1e-4 * s.force_scale(); // below every friction that matters to the command
        const auto beginning = [&](double more) {
            return std::max({s.leader.friction.coulomb + more, 0.3 * s.leader.friction.coulomb, scale});
        };
        std::vector<std::vector<parameter>> out;
        for (const double start : {beginning(jump), beginning(resists)})
            if (out.empty() || start > 2 * out.front().front().start)
                out.push_back({{.key = "coulomb_N",
                                .of = [](plant_model& p) -> double& { return p.friction.coulomb; },
                                .start = start,
                                .low = std::min(0.1 * start, scale),
                                .high = s.farthest(20 * start + 100 * scale, s.force_scale()),
                                .logarithmic = true,
                                .step = 1e-3}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"coulomb_N", {p.friction.coulomb}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
