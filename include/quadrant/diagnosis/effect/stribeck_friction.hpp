// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// F = (Fs - Fc) exp(-(|v|/vs)^d) sign(v) on top of the Coulomb level; d = 1: [Jamaludin2008] eq. (3.5), d = 2:
/// LuGre's curve [Armstrong1994]. Joins the force, in the friction box. Shows as a residual that grows as the
/// axis gets slower.
inline constexpr effect stribeck_friction{
    .name = "stribeck_friction",
    .label = "Stribeck friction",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "slow reversals and constant speeds from creep to a few times the Stribeck velocity",
    .ends_inside = {"stribeck_velocity_m_per_s"}, // slower than the record shows, it is the give of the contact
    .shows = "grows as the axis gets slower",
    .keys = {machine_key{.name = "static_N",
                         .rule = detail::rule::not_negative,
                         .meaning = "friction at rest, not below coulomb_N",
                         .at = member<&plant_description::static_N>,
                         .needs = {"stribeck_velocity_m_per_s"},
                         .tolerance = true},
             machine_key{.name = "stribeck_velocity_m_per_s",
                         .rule = detail::rule::positive,
                         .meaning = "speed at which the excess over coulomb_N has fallen to 1/e",
                         .at = member<&plant_description::stribeck_velocity_m_per_s>,
                         .needs = {"static_N"},
                         .tolerance = true},
             machine_key{.name = "stribeck_exponent",
                         .rule = detail::rule::exponent,
                         .meaning =
                             "of the speed over the Stribeck velocity: 1 falls evenly, 2 has a round top",
                         .at = member<&plant_description::stribeck_exponent>,
                         .needs = {"static_N", "stribeck_velocity_m_per_s"}}},
    .fault = [](const axis_description& a) -> key_fault {
        if (a.plant.static_N && *a.plant.static_N < a.plant.coulomb_N.value_or(0))
            return {"static_N", "must not lie below {}", "coulomb_N"};
        return {};
    },
    .prior = {0.6, "sliding guides and seals have it; rolling guides have little of it"},
    .compensation = "the law over speed (friction_feedforward<stribeck>)",
    .remedy = "Feed the friction forward by its law over speed; a smoother guide oil or a rolling guide "
              "removes the cause.",
    .trial = {.low = 0.01,
              .high = 4,
              .into =
                  [](trial_machine& m) {
                      m.set("static_N", m.now("coulomb_N") * (1 + m.amplitude));
                      m.set("stribeck_velocity_m_per_s", m.log_uniform(1e-3, 1e-2));
                  },
              .needs_coulomb = true,
              .slow_shows_it = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double peak = s.record.scale.speed, give = s.leader.friction.contact.length;
        // Slower than that the contact still gives way, by another law than this one.
        const double creep = give > s.record.scale.give() ? give / s.record.scale.response() : 0;
        const double slowest = std::max(8e-4 * peak, creep), fastest = 0.4 * peak;
        std::vector<std::vector<parameter>> out;
        std::vector<double> velocities;
        for (double share : {0.004, 0.02, 0.08})
            if (share * peak > 1.25 * slowest) velocities.push_back(share * peak);
        if (velocities.empty() && slowest < fastest / 2) velocities.push_back(1.25 * slowest);
        // A described curve that is only too low or too high keeps its speed.
        if (s.leader.friction.excess > 0) velocities.push_back(s.leader.friction.stribeck_velocity);
        for (double velocity : velocities) {
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
                            .high = std::max(20 * start, s.force_scale()), // what breaks away, the motor moves
                            .logarithmic = true,
                            .step = 1e-3},
                           {.key = "stribeck_velocity_m_per_s",
                            .of = [](plant_model& p) -> double& { return p.friction.stribeck_velocity; },
                            .start = velocity,
                            .low = std::min(slowest, 0.8 * velocity),
                            .high = std::max(fastest, 1.25 * velocity),
                            .logarithmic = true,
                            .step = 1e-3},
                           {.key = "stribeck_exponent",
                            .of = [](plant_model& p) -> double& { return p.friction.stribeck_exponent; },
                            .start = s.leader.friction.stribeck_exponent,
                            .low = 0.5,
                            .high = 2.5,
                            .logarithmic = true,
                            .step = 1e-3}});
        }
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"static_N", {p.friction.coulomb + p.friction.excess}},
                {"stribeck_velocity_m_per_s", {p.friction.stribeck_velocity}},
                {"stribeck_exponent", {p.friction.stribeck_exponent}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
