// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The drive runs from another voltage than described. Joins the drive. Scales the torque of every duty, as the
/// torque constant does.
inline constexpr effect supply_voltage{
    .name = "supply_voltage",
    .label = "supply voltage of the drive",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "strong accelerations beside a rest against a known load",
    .equivalent = {"force_constant", "drive_gain"},
    .shows = "proportional to the duty",
    .keys = {machine_key{.name = "drive.supply_V",
                         .rule = detail::rule::positive,
                         .meaning = "voltage at a duty of 1",
                         .at = member<&drive_description::supply_V>,
                         .of = [](plant_model& p) -> double& { return p.drive.supply; },
                         .neutral = 1,
                         .tolerance = true}},
    .prior = {0.3, "batteries and long leads sag"},
    .remedy = "Measure the voltage at the drive while it works.",
    .trial = {.low = 0.02,
              .high = 1,
              .into =
                  [](trial_machine& m) {
                      m.set("drive.supply_V", m.changed(m.described("drive.supply_V"), 0.3));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        std::vector<std::vector<parameter>> out;
        if (s.leader.drive.kind == drive_kind::position_servo)
            detail::free_if_there(out, s, "drive.supply_V",
                                  [](plant_model& p) -> double& { return p.drive.supply; });
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"drive.supply_V", {p.drive.supply}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
