// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// F = -k x + F0: a cable carrier, a bellows, a spring-balanced axis. Joins the force. Shows as a residual
/// proportional to the position, at rest too, that does not turn with the direction. Where the spring is at
/// ease is its own: the constant belongs to it, so that the zero of the position does not matter.
inline constexpr effect position_spring{
    .name = "position_spring",
    .label = "spring force",
    .box = "mechanics",
    .joins = joint::force,
    .exciting_motion = "slow strokes over the whole travel in both directions, with rest at both ends",
    .holds = "constant_force",
    .shows = "proportional to position",
    .keys = {machine_key{.name = "spring_N_per_m",
                         .rule = detail::rule::any_number,
                         .meaning = "force -spring x about position 0",
                         .at = member<&plant_description::spring_N_per_m>,
                         .of = [](plant_model& p) -> double& { return p.spring; },
                         .tolerance = true}},
    .prior = {0.1, "cable carriers and bellows pull, most of them weakly"},
    .compensation = "a gain on the position",
    .remedy = "Add a command proportional to the position; look at cable carrier, bellows and counterweight.",
    .trial = {.low = 1e-4,
              .high = 1,
              .into =
                  [](trial_machine& m) {
                      m.set("spring_N_per_m", m.amplitude * m.around.peak_force / m.around.travel);
                  },
              .slow_shows_it = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        double xx = 0, xf = 0, mean_x = 0, mean_f = 0, furthest = 0;
        const auto n = static_cast<double>(s.residual.size());
        for (std::size_t k = 0; k < s.residual.size(); ++k) {
            mean_x += s.record.position[k] / n;
            mean_f += s.residual[k] / n;
            furthest = std::max(furthest, std::abs(s.record.position[k]));
        }
        for (std::size_t k = 0; k < s.residual.size(); ++k) {
            xx += (s.record.position[k] - mean_x) * (s.record.position[k] - mean_x);
            xf += (s.record.position[k] - mean_x) * (s.residual[k] - mean_f);
        }
        const double travel = detail::travel(s), most = 3 * s.force_scale() * (1 + furthest / travel);
        if (!(travel > 0)) return {};
        std::vector<std::vector<parameter>> out;
        for (const double slope : s.beginnings(s.leader.spring, xx > 0 ? xf / xx : 0))
            out.push_back({{.key = "spring_N_per_m",
                            .of = [](plant_model& p) -> double& { return p.spring; },
                            .start = slope,
                            .low = 0,
                            .high = 2 * s.force_scale() / travel,
                            .step = 1e-6 * s.force_scale() / travel},
                           {.key = "constant_force_N",
                            .of = [](plant_model& p) -> double& { return p.constant_force; },
                            .start = s.leader.constant_force + (slope - s.leader.spring) * mean_x - mean_f,
                            .low = -most,
                            .high = most,
                            .step = 1e-6 * s.force_scale()}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"spring_N_per_m", {p.spring}}, {"constant_force_N", {p.constant_force}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
