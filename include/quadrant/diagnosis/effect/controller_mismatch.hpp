// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The controller that ran is not the one described. It is found by replay of the logged reference and
/// position, not by a fit of the plant (controller_mismatch.hpp); its keys are those of the controller's kind.
inline constexpr effect controller_mismatch{
    .name = "controller_mismatch",
    .label = "controller",
    .box = "controller",
    .joins = joint::command,
    .exciting_motion = "any motion",
    .shows = "replay that differs",
    .prior = {0.5, "gains are changed at the machine, and the file is not"},
    .remedy = "Set the controller as described, or take into the machine file what ran.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "set the controller as described, or keep what ran: no compensation is missing";
    },
    .trial = {.low = 0.005, .high = 1, .into = [](trial_machine& m) { m.change_controller(); }},
};

} // namespace quadrant::inline v0::diagnosis::suspect
