// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// B (1 + b sign v) v + Fc (1 + c sign v) sign v: friction differs by direction. Joins the force, in the
/// friction box. The Coulomb part alone is a constant force, moving and at rest; the viscous part is not.
inline constexpr effect asymmetric_friction{
    .name = "asymmetric_friction",
    .label = "friction that differs by direction",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "the same stroke in both directions at a slow and a fast constant speed",
    .equivalent = {"constant_force"},
    .shows = "differs by direction",
    .keys = {machine_key{.name = "viscous_asymmetry",
                         .rule = detail::rule::asymmetry,
                         .meaning = "relative, signed: viscous friction times (1 + a sign v)",
                         .at = member<&plant_description::viscous_asymmetry>,
                         .of = [](plant_model& p) -> double& { return p.friction.viscous_asymmetry; },
                         .tolerance = true,
                         .percent = true},
             machine_key{.name = "coulomb_asymmetry",
                         .rule = detail::rule::asymmetry,
                         .meaning = "relative, signed: Coulomb level times (1 + a sign v)",
                         .at = member<&plant_description::coulomb_asymmetry>,
                         .of = [](plant_model& p) -> double& { return p.friction.coulomb_asymmetry; },
                         .tolerance = true,
                         .percent = true},
             machine_key{.name = "static_asymmetry",
                         .rule = detail::rule::asymmetry,
                         .meaning = "relative, signed: static level times (1 + a sign v)",
                         .at = member<&plant_description::static_asymmetry>,
                         .needs = {"static_N"},
                         .percent = true},
             machine_key{.name = "stribeck_velocity_asymmetry",
                         .rule = detail::rule::asymmetry,
                         .meaning = "relative, signed: Stribeck velocity times (1 + a sign v)",
                         .at = member<&plant_description::stribeck_velocity_asymmetry>,
                         .needs = {"static_N"},
                         .percent = true}},
    .prior = {0.3, "wipers, seals and nuts are seldom the same both ways, but the difference is small"},
    .compensation = "a constant and a gain on the speed",
    .remedy =
        "Feed a friction forward that differs by direction; look at wipers and at the preload of the nut.",
    .trial = {.low = 0.01,
              .high = 0.9,
              .into =
                  [](trial_machine& m) {
                      const double sign = m.sign();
                      const bool has_coulomb = m.described("coulomb_N") > 0;
                      if (!has_coulomb || m.chance(0.5)) m.set("viscous_asymmetry", sign * m.amplitude);
                      if (has_coulomb) m.set("coulomb_asymmetry", sign * 0.7 * m.amplitude);
                  },
              .slow_shows_it = true},
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

} // namespace quadrant::inline v0::diagnosis::suspect
