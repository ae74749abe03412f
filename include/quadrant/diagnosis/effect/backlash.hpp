// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Play between the motor and the encoder on the load: the reading stands still until the motor has crossed it.
/// Joins the position. Shows at each reversal as a pause of the reading at full command, as long as the play is
/// wide. A direct drive
/// cannot have it: name it in excluded_effects.
inline constexpr effect backlash{
    .name = "backlash",
    .label = "backlash",
    .box = "mechanics",
    .joins = joint::transmission,
    .exciting_motion = "slow reversals of 0.1 mm and more, with rest before each",
    .shows = "a reading that stands still at full command after a reversal",
    .keys = {machine_key{.name = "backlash_m",
                         .rule = detail::rule::not_negative,
                         .meaning = "play between drive and encoder",
                         .at = member<&plant_description::backlash_m>,
                         .of = [](plant_model& p) -> double& { return p.backlash; },
                         .tolerance = true}},
    .prior = {0.4, "screws, gears and couplings wear; a direct drive cannot have it"},
    .remedy =
        "Preload the nut or the gear; an encoder on the load lets the loop see the play, but not remove it.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            return fmt::format(
                "preload or a stiffer drive ({:.3g} um of play): the encoder sits behind the play, so "
                "that the loop sees it already; backlash_compensation is for an encoder before it",
                1e6 * p.backlash);
        },
    .trial = {.low = 5e-7, .high = 5e-4, .into = [](trial_machine& m) { m.set("backlash_m", m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.backlash; };
        const double count = s.record.resolution, travel = s.record.scale.travel;
        std::vector<double> ladder;
        for (double share : {5e-6, 1.5e-5, 5e-5, 1.5e-4, 5e-4})
            ladder.push_back(std::max(share * travel, 2 * count));
        return {{{.key = "backlash_m",
                  .of = of,
                  .start = detail::best_start(s, of, ladder),
                  .low = count,
                  .high = std::max(5e-3 * travel, 40 * count),
                  .logarithmic = true,
                  .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"backlash_m", {p.backlash}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
