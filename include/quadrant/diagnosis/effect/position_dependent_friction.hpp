// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::inline v0::diagnosis::detail {
inline harmonics& position_dependent_friction_harmonics(plant_model& p) { return p.friction.along; }
} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// Fc (1 + amplitude sin(2 pi x / period + phase)) sign(v): the Coulomb level varies along the travel, as on a
/// guide that is not straight or a screw that is tight at one end. Joins the force, in the friction box. Shows
/// as a residual that repeats with position and turns its sign with the direction; cogging does not turn.
inline constexpr effect position_dependent_friction{
    .name = "position_dependent_friction",
    .label = "friction that varies along the travel",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "the same slow stroke in both directions over the whole travel",
    .equivalent = {"load_friction"},               // the weight of a joint loads it by its angle
    .ends_inside = {"friction_position_period_m"}, // a trend along the travel, or another law, has no period
    .shows = "friction whose level varies along the travel",
    .keys = {machine_key{.name = "friction_position_amplitude",
                         .rule = detail::rule::asymmetry,
                         .meaning = "of the Coulomb level along the travel, relative",
                         .at = member<&plant_description::friction_position_amplitude>,
                         .needs = {"friction_position_period_m"},
                         .components = detail::components_of<detail::position_dependent_friction_harmonics>,
                         .tolerance = true,
                         .percent = true},
             machine_key{.name = "friction_position_period_m",
                         .rule = detail::rule::positive,
                         .meaning = "of that wave",
                         .at = member<&plant_description::friction_position_period_m>,
                         .needs = {"friction_position_amplitude"},
                         .of = [](plant_model& p) -> double& {
                             return detail::position_dependent_friction_harmonics(p).period;
                         },
                         .tolerance = true,
                         .unstated = 0},
             machine_key{.name = "friction_position_phase_rad",
                         .rule = detail::rule::any_number,
                         .meaning = "of that wave",
                         .at = member<&plant_description::friction_position_phase_rad>}},
    .prior = {0.3,
              "guides that are not straight and screws that are tight at one end are common on old machines"},
    .compensation = "harmonics times the sign of the motion",
    .remedy = "Feed the friction forward along the travel; align the guide, or have the screw looked at where "
              "it is tight.",
    .trial = {.low = 0.01,
              .high = 0.9,
              .into =
                  [](trial_machine& m) {
                      const double period = m.passed_period();
                      m.set("friction_position_period_m", period);
                      m.set_harmonics("friction_position_amplitude", "friction_position_phase_rad", 1,
                                      m.amplitude);
                  },
              .needs_coulomb = true,
              .slow_shows_it = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (!(s.leader.friction.coulomb > 0)) return {};
        const double travel = detail::travel(s);
        const double peak = s.record.scale.speed;
        std::vector<double> direction(s.residual.size());
        for (std::size_t k = 0; k < direction.size(); ++k) {
            const double v = s.record.velocity[k];
            direction[k] = std::abs(v) < 0.005 * peak ? 0 : v > 0 ? 1 : -1;
        }
        for (std::size_t k = 0; k < s.record.left_out.size(); ++k)
            if (s.record.left_out[k]) direction[k] = 0;
        std::vector<std::vector<parameter>> out;
        for (double period : carried_peaks(s.residual, direction, s.record.position, 2 * travel, travel / 50, 2,
                                           s.record.score.skip))
            out.push_back(detail::repeating<detail::position_dependent_friction_harmonics, 1>(
                "friction_position_period_m", "friction_position_amplitude", period, travel, 0.95));
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"friction_position_amplitude", p.friction.along.sizes()},
                {"friction_position_period_m", {p.friction.along.period}},
                {"friction_position_phase_rad", p.friction.along.phases()}};
    },
    .join = [](plant_model& p, const screening&) { p.friction.along.count = 1; }};

} // namespace quadrant::inline v0::diagnosis::suspect
