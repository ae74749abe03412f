// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Probability above which no drive follows its set-points.
inline constexpr double most_lost = 0.5;

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// Some set-points never arrive, and the drive repeats the one before. Joins the drive. Which they were is not
/// known: a model has what they do on average, a set-point that lags by p / (1 - p) periods. Above one half
/// this is more than a period: no jitter around the newest set-point, but a delay or a filter. No drive runs
/// so: at one half three in a row are lost every 14 periods, and drives stop with a communication fault after
/// a few missed ones.
inline constexpr effect set_point_loss{
    .name = "set_point_loss",
    .label = "lost set-points",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "a long fast stroke and sharp starts",
    .equivalent = {"command_delay"},
    .shows = "in single periods, while the set-points move",
    .keys = {machine_key{.name = "drive.set_point_loss",
                         .rule = detail::rule::relative,
                         .meaning = "probability of a set-point; a lost one repeats the previous; absent: 0",
                         .at = member<&drive_description::set_point_loss>}},
    .prior = {0.1, "a bus without synchronous clocks loses some"},
    .remedy = "Synchronise the clocks of bus and controller, and watch the drive's counter of lost frames.",
    .trial = {.low = 0.001,
              .high = 0.4,
              .into = [](trial_machine& m) { m.set("drive.set_point_loss", m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (s.leader.drive.kind != drive_kind::position && s.leader.drive.kind != drive_kind::position_servo)
            return {};
        return {{{.key = "drive.set_point_loss",
                  .of = [](plant_model& p) -> double& { return p.drive.loss; },
                  .start = 0.1,
                  .low = 0,
                  .high = detail::most_lost,
                  .step = 1e-3}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"drive.set_point_loss", {p.drive.loss}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
