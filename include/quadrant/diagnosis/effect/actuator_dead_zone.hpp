// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Commands below the dead zone have no effect, larger ones lose it: an output stage without bias, or a
/// controller's dead band in the drive. Joins the actuator. Shows when the command changes its sign, at any
/// speed; friction turns with the velocity instead.
inline constexpr effect actuator_dead_zone{
    .name = "actuator_dead_zone",
    .label = "actuator dead zone",
    .box = "actuator",
    .joins = joint::command,
    .exciting_motion = "slow reversals beside accelerations in which the command changes its sign in motion",
    .ends_inside = {"actuator.dead_zone_V"}, // so wide that little of the command passes, it is none
    .shows = "when the command changes its sign",
    .keys = {machine_key{.name = "actuator.dead_zone_V",
                         .rule = detail::rule::not_negative,
                         .meaning = "commands below it have no effect, larger ones lose it",
                         .at = member<&actuator_description::dead_zone_V>,
                         .of = [](plant_model& p) -> double& { return p.dead_zone; },
                         .tolerance = true}},
    .prior = {0.03, "hydraulic valves and cheap output stages have it; servo amplifiers seldom"},
    .remedy = "Invert the dead zone in the drive: it needs the direction of the whole command.",
    .advice =
        [](const plant_model& p, double, std::string_view unit) {
            return fmt::format(
                "the inverse in the drive: {:.3g} {} more in the direction of the whole command; the "
                "reference does not know that direction",
                p.dead_zone, unit);
        },
    .trial = {.low = 1e-4,
              .high = 1,
              .into = [](trial_machine& m) { m.set("actuator.dead_zone_V", m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double usual = rms(s.record.command);
        if (!(usual > 0)) return {};
        // One above the command's rms swallows more than it lets through: a model that stands still.
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.dead_zone; };
        return {
            {{.key = "actuator.dead_zone_V",
              .of = of,
              .start = detail::best_start(s, of, {0.01 * usual, 0.03 * usual, 0.1 * usual, 0.3 * usual, usual}),
              .low = 1e-4 * usual,
              .high = usual,
              .logarithmic = true,
              .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.dead_zone_V", {p.dead_zone}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
