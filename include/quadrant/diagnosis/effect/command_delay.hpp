// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Set-points reach the loops of the drive later (or earlier) than described. Joins the drive. Shows as a force
/// that follows the velocity and acceleration of the set-points.
inline constexpr effect command_delay{
    .name = "command_delay",
    .label = "delay of the set-points",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "sharp starts and stops, or a sweep up to the drive's bandwidth",
    .equivalent = {"set_point_loss"},
    .shows = "follows the velocity of the set-points",
    .keys = {machine_key{.name = "drive.command_delay_s",
                         .rule = detail::rule::up_to_a_second,
                         .meaning = "from the row to the drive's use of its set-point; absent: none",
                         .at = member<&drive_description::command_delay_s>,
                         .of = [](plant_model& p) -> double& { return p.drive.delay; },
                         .tolerance = true}},
    .prior = {0.6, "buses and drives delay by a period or two that no file mentions"},
    .remedy = "Shorten the bus cycle, or run the reference ahead by the delay.",
    .trial = {.low = 0.05,
              .high = 6,
              .into =
                  [](trial_machine& m) {
                      m.set("drive.command_delay_s",
                            m.described("drive.command_delay_s") + m.amplitude * m.around.period);
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (!s.leader.drive.closes()) return {};
        const double t = s.record.period;
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.drive.delay; };
        const double now = s.leader.drive.delay;
        return {{{.key = "drive.command_delay_s",
                  .of = of,
                  .start = detail::best_start(s, of,
                                              {now + 0.3 * t, now + t, now + 2 * t, now + 4 * t, now + 8 * t}),
                  .low = 0,
                  .high = now + 16 * t,
                  .step = 0.05 * t}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"drive.command_delay_s", {p.drive.delay}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
