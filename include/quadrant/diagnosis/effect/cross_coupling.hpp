// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// M c a_other: the acceleration of the other axis forces this one, through a guide that is not square or a
/// base that gives way. Joins the force. Shows while the other axis accelerates, at rest too.
inline constexpr effect cross_coupling{
    .name = "cross_coupling",
    .label = "coupling from the other axis",
    .box = "mechanics",
    .joins = joint::force,
    .exciting_motion = "accelerate the other axis while this one rests, then both in a circle",
    .shows = "the other axis' acceleration",
    .keys = {machine_key{.name = "coupling",
                         .rule = detail::rule::any_number,
                         .meaning =
                             "this axis' acceleration gains coupling times the other's, of the same kind",
                         .at = member<&plant_description::coupling>,
                         .of = [](plant_model& p) -> double& { return p.coupling; },
                         .tolerance = true}},
    .prior = {0.1,
              "stacked axes and soft machine beds have it; it shows only while the other axis accelerates"},
    .remedy = "Feed the other axis' reference acceleration forward in this command; check squareness and how "
              "the machine stands.",
    .advice =
        [](const plant_model& p, double, std::string_view unit) {
            return fmt::format(
                "the other axis' reference acceleration times {:.3g} {} s^2/m in this command (not simulated "
                "here: the log of one axis does not say what the other is asked for next)",
                -p.moving_mass() * p.coupling / p.force_constant, unit);
        },
    .trial = {.low = 0.001,
              .high = 0.5,
              .into = [](trial_machine& m) { m.set("coupling", m.sign() * m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const auto& other = s.record.observer.other_acceleration;
        double aa = 0, af = 0;
        for (std::size_t k = 0; k < other.size(); ++k) {
            aa += other[k] * other[k];
            af += other[k] * s.residual[k];
        }
        if (!(aa > 0)) return {};
        // A joint that the other one carries along has 1 + l1/l2 and more: its angle is relative to that one's.
        constexpr double most = 10;
        return {{{.key = "coupling",
                  .of = [](plant_model& p) -> double& { return p.coupling; },
                  .start = std::clamp(s.leader.coupling - af / aa / s.leader.mass, -0.5 * most, 0.5 * most),
                  .low = -most,
                  .high = most,
                  .step = 1e-4}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"coupling", {p.coupling}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
