// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Error of screw or gear that repeats each turn.
/// Found by the difference of two readings (chain/search.hpp), not by a fit of the plant.
inline constexpr effect pitch_error{
    .name = "pitch_error",
    .label = "pitch error",
    .box = "transmission",
    .joins = joint::transmission,
    .exciting_motion = "slow strokes over many turns, in both directions",
    .equivalent = {"encoder_cyclic_error"},
    .shows = "a difference of the two readings that repeats with each turn of the motor",
    .keys = {machine_key{.name = "transmission.pitch_error_m",
                         .rule = detail::rule::any_number,
                         .meaning =
                             "load = motor + sum of pitch_error sin(2 pi j x / pitch_period + pitch_phase)",
                         .at = member<&transmission_description::pitch_error_m>,
                         .shape = key_shape::harmonics},
             machine_key{.name = "transmission.pitch_period_m",
                         .rule = detail::rule::positive,
                         .meaning = "of the first of them; absent: travel_per_turn_m",
                         .at = member<&transmission_description::pitch_period_m>},
             machine_key{.name = "transmission.pitch_phase_rad",
                         .rule = detail::rule::any_number,
                         .meaning = "one entry a harmonic; absent: 0",
                         .at = member<&transmission_description::pitch_phase_rad>,
                         .entries_of = "pitch_error_m",
                         .shape = key_shape::harmonics}},
    .fault = [](const axis_description& a) -> key_fault {
        const transmission_description& t = a.transmission;
        if (t.pitch_error_m.empty() || t.pitch_period_m || t.travel_per_turn_m) return {};
        return {.key = "transmission.pitch_error_m", .rule = "needs {}", .other = "pitch_period_m"};
    },
    .prior = {0.6, "screws and gears repeat their errors each turn"},
    .remedy = "Write a pitch table into the control, or close the loop on the scale; an encoder that sits off "
              "centre on the motor reads the same.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "a pitch table over one turn in the control; an encoder that sits off centre on the motor reads "
               "the same";
    },
};

} // namespace quadrant::inline v0::diagnosis::suspect
