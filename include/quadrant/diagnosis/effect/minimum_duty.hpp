// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The servo adds another least duty in the direction of its error than described. Joins the drive. Shows as a
/// force of one size that turns with the sign of the error; without a measured duty it is much like friction in
/// the direction of motion.
inline constexpr effect minimum_duty{
    .name = "minimum_duty",
    .label = "least duty of the servo",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "small slow strokes with rests, in which the error changes its sign",
    .equivalent = {"coulomb_friction"},
    .shows = "of one size, with the sign of the error inside the drive",
    .keys = {machine_key{.name = "drive.minimum_duty",
                         .rule = detail::rule::duty_or_none,
                         .meaning = "duty added in the direction of the error; absent: none",
                         .at = member<&drive_description::minimum_duty>,
                         .of = [](plant_model& p) -> double& { return p.drive.minimum_duty; },
                         .tolerance = true}},
    .prior = {0.1, "some servos add it against the friction of their gear"},
    .remedy = "Read the servo's registers (PWM offset, punch).",
    .trial = {.low = 0.001,
              .high = 0.3,
              .into = [](trial_machine& m) { m.set("drive.minimum_duty", m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (s.leader.drive.kind != drive_kind::position_servo) return {};
        const double most = detail::most_given(s);
        if (!(most > 0)) return {};
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.drive.minimum_duty; };
        return {{{.key = "drive.minimum_duty",
                  .of = of,
                  .start = detail::best_start(s, of,
                                              {0.003 * most, 0.01 * most, 0.03 * most, 0.1 * most, 0.3 * most}),
                  .low = 0,
                  .high = most,
                  .step = 1e-4 * most}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"drive.minimum_duty", {p.drive.minimum_duty}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
