// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// F = Fc sign(v), stick at rest [Armstrong1994]. Joins the force, in the friction box. Shows as a residual that
/// jumps with the direction and does not change with speed.
inline constexpr effect coulomb_friction{
    .name = "coulomb_friction",
    .box = "mechanics",
    .exciting_motion = "slow strokes in both directions at two constant speeds",
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
