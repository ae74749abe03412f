// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"
#include "sample_loss.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Some set-points never arrive, and the drive repeats the one before. Joins the drive. Shows as pulses as
/// large as what the set-points changed by; which ones they were is found like lost commands
/// (model/sample_loss.hpp), in what was measured behind the drive where something was, else in the path.
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
        plant_model plant = s.leader;
        plant.drive.loss = 0;
        std::vector<double> without;
        if (s.leader.drive.loss > 0) s.record.observer.run(plant, without);
        const auto& innovation = s.leader.drive.loss > 0 ? without : s.innovation;
        return detail::counted_losses(
            "drive.set_point_loss", [](plant_model& p) -> double& { return p.drive.loss; },
            [&](double size) {
                return s.record.observer.set_points_with_loss(plant, innovation,
                                                              {.learned = true, .size = size});
            });
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"drive.set_point_loss", {p.drive.loss}}};
    },
    .join =
        [](plant_model& p, const screening& s) {
            constexpr double some = 0.05; // the share is learned
            p.drive.loss = some;
            p.drive.received = s.record.observer.received(p);
        }};

} // namespace quadrant::inline v0::diagnosis::suspect
