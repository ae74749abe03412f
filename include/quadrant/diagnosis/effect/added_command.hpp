// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// A signal is added to the command in parts of the record: of a test, or by a fault. It is found by replay of
/// the controller, not by a fit of the plant (added/find_added.hpp); its waveform stands in the diagnosis.
inline constexpr effect added_command{
    .name = "added_command",
    .label = "added command",
    .box = "controller",
    .joins = joint::command,
    .exciting_motion = "any motion, with a while before the signal begins",
    .shows = "replay that differs in parts of the record, by a signal of time",
    .prior = {0.1, "a test signal or a fault of the wiring; rarer than a gain that was changed"},
    .remedy = "Find what adds the signal to the command, or record again without it.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "find what adds the signal to the command: no compensation is missing";
    },
};

} // namespace quadrant::inline v0::diagnosis::suspect
