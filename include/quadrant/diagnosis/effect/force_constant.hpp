// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// F = kf u with another kf than described. Joins the actuator gain. Scales whatever the command does:
/// acceleration, and also what balances friction and offset.
inline constexpr effect force_constant{
    .name = "force_constant",
    .label = "force constant",
    .box = "actuator",
    .joins = joint::motor_gain,
    .exciting_motion = "strong accelerations beside slow strokes against known friction, or a known load",
    .shows = "proportional to the command",
    .keys = {machine_key{.name = "force_constant_N_per_V",
                         .rule = detail::rule::positive,
                         .meaning = "force for one unit of the command; its last letter is that unit (V or A), "
                                    "and it is absent where the command is the force",
                         .at = member<&plant_description::force_constant_N_per_V>,
                         .tolerance = true,
                         .unit_of_command = true}},
    .prior = {0.6, "data sheets give it within five to ten per cent, and warm magnets lose some"},
    .compensation = "the key acceleration_feedforward_V_s2_per_m",
    .remedy = "Set force constant and feedforwards to the value found; check the scaling of the amplifier.",
    .trial = {.low = 0.005,
              .high = 1,
              .into =
                  [](trial_machine& m) {
                      m.set("force_constant_N_per_V", m.changed(m.now("force_constant_N_per_V"), 0.3));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (s.leader.drive.closes())
            return {{detail::freed_from_the_best(s, "force_constant_N_per_V",
                                                 [](plant_model& p) -> double& { return p.force_constant; })}};
        return {{detail::freed(
            "force_constant_N_per_V", [](plant_model& p) -> double& { return p.force_constant; },
            s.leader.force_constant)}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"force_constant_N_per_V", {p.force_constant}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
