// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// F = (Fs - Fc) exp(-|v|/vs) sign(v) on top of the Coulomb level [Jamaludin2008] eq. (3.5). Joins the force, in the
/// friction box. Shows as a residual that grows as the axis gets slower.
inline constexpr effect stribeck_friction{
    .name = "stribeck_friction",
    .box = "mechanics",
    .exciting_motion = "slow reversals and constant speeds from creep to a few times the Stribeck velocity",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double peak = s.record.scale.speed;
        std::vector<std::vector<parameter>> out;
        for (double slow : {0.004, 0.02, 0.08}) {
            const double velocity = slow * peak;
            const double force = detail::mean_residual(s,
                                                       [&](std::size_t k) {
                                                           const double v = s.record.velocity[k];
                                                           return v > 0.1 * velocity && v < velocity;
                                                       }) -
                                 detail::mean_residual(s, [&](std::size_t k) {
                                     const double v = s.record.velocity[k];
                                     return -v > 0.1 * velocity && -v < velocity;
                                 });
            const double scale = 1e-4 * s.force_scale();
            const double start =
                std::max({s.leader.friction.excess + 0.5 * force, 0.3 * s.leader.friction.excess, scale});
            out.push_back({{.key = "static_N",
                            .of = [](plant_model& p) -> double& { return p.friction.excess; },
                            .start = start,
                            .low = 0.1 * scale,
                            .high = 20 * start + 100 * scale,
                            .logarithmic = true,
                            .step = 1e-3},
                           {.key = "stribeck_velocity_m_per_s",
                            .of = [](plant_model& p) -> double& { return p.friction.stribeck_velocity; },
                            .start = velocity,
                            .low = 8e-4 * peak,
                            .high = 0.4 * peak,
                            .logarithmic = true,
                            .step = 1e-3}});
        }
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"static_N", {p.friction.coulomb + p.friction.excess}},
                {"stribeck_velocity_m_per_s", {p.friction.stribeck_velocity}}};
    }};

} // namespace quadrant::diagnosis::suspect
