// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "payload_mass.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The payload sits at another distance than described. Moves the inertia with the square of the length and
/// gravity with the
/// length itself: where the inertia of the payload is too small to show, it is one group with `payload_mass`.
inline constexpr effect arm_length{
    .name = "arm_length",
    .label = "longer or shorter arm",
    .box = "mechanics",
    .joins = joint::force,
    .exciting_motion = "strong accelerations beside slow strokes, hanging and level",
    .equivalent = {"payload_mass", "gravity", "mass"},
    .shows =
        "a sine of the position and a part that follows the acceleration, more of it than another mass makes",
    .keys = {machine_key{.name = "payload.arm_m",
                         .rule = detail::rule::positive,
                         .meaning = "distance of the payload's mass from the axis",
                         .at = member<&payload_description::arm_m>,
                         .needs = {"mass_kg"},
                         .same_when_rotary = true}},
    .rotary_only = true,
    .prior = {0.2, "grippers and fixtures are mounted at another hole; arms are seldom exchanged"},
    .remedy =
        "Measure the distance of the payload from the axis and describe it; set the feedforward of gravity and "
        "acceleration to it.",
    .advice = detail::feedforwards_of_payload,
    .trial = {.low = 0.01,
              .high = 0.8,
              .into =
                  [](trial_machine& m) { m.set("payload.arm_m", m.changed(m.described("payload.arm_m"))); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (!(s.leader.payload.inertia() > 0)) return {};
        return {{detail::freed(
            "payload.arm_m", [](plant_model& p) -> double& { return p.payload.arm; }, s.leader.payload.arm)}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        std::vector<key_value> out{{"payload.arm_m", {p.payload.arm}}};
        detail::add_what_payload_moves(out, p);
        return out;
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
