// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The motor loses steps, or a coupling slips: the difference of two readings jumps and stays. The rows and
/// sizes stand in
/// the diagnosis.
inline constexpr effect missed_steps{
    .name = "missed_steps",
    .label = "missed steps",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "the motion that the machine runs, with the scale recorded",
    .shows = "a difference of the two readings that jumps at some times and stays",
    .prior = {0.4, "a stepper that is overloaded loses steps; a coupling slips"},
    .remedy = "Lower acceleration or speed, raise the motor's current, or look for what blocks the axis at "
              "these places.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "lower acceleration or speed, or raise the motor's current: no compensation brings steps back";
    },
};

} // namespace quadrant::inline v0::diagnosis::suspect
