// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// B (1 + b sign v) v + Fc (1 + c sign v) sign v: friction differs by direction. Joins the force, in the friction
/// box. The Coulomb part alone is a constant force, moving and at rest; the viscous part is not.
inline constexpr effect asymmetric_friction{
    .name = "asymmetric_friction",
    .box = "mechanics",
    .exciting_motion = "the same stroke in both directions at a slow and a fast constant speed",
    .equivalent = "constant_force",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        std::vector<parameter> ps{{.key = "viscous_asymmetry",
                                   .of = [](plant_model& p) -> double& { return p.friction.viscous_asymmetry; },
                                   .start = s.leader.friction.viscous_asymmetry,
                                   .low = -0.95,
                                   .high = 0.95,
                                   .step = 1e-3}};
        if (s.leader.friction.coulomb > 0)
            ps.push_back({.key = "coulomb_asymmetry",
                          .of = [](plant_model& p) -> double& { return p.friction.coulomb_asymmetry; },
                          .start = s.leader.friction.coulomb_asymmetry,
                          .low = -0.95,
                          .high = 0.95,
                          .step = 1e-3});
        return {ps};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        std::vector<key_value> out{{"viscous_asymmetry", {p.friction.viscous_asymmetry}}};
        if (p.friction.coulomb > 0) out.push_back({"coulomb_asymmetry", {p.friction.coulomb_asymmetry}});
        return out;
    }};

} // namespace quadrant::diagnosis::suspect
