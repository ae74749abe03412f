// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Smooth part of the pitch error, beside what is proportional to the travel.
/// Found by the difference of two readings (chain/search.hpp), not by a fit of the plant.
inline constexpr effect travel_error{
    .name = "travel_error",
    .label = "smooth error along the travel",
    .box = "transmission",
    .joins = joint::transmission,
    .exciting_motion = "slow strokes over the whole travel",
    .shows = "a difference of the two readings that is a smooth curve of the position",
    .keys = {machine_key{.name = "transmission.travel_error_m",
                         .rule = detail::rule::any_number,
                         .meaning = "smooth part of the pitch error: Legendre polynomials of order 2 on "
                                    "between the two places below",
                         .at = member<&transmission_description::travel_error_m>,
                         .shape = key_shape::harmonics},
             machine_key{.name = "transmission.travel_error_from_m",
                         .rule = detail::rule::any_number,
                         .meaning = "where that curve begins",
                         .at = member<&transmission_description::travel_error_from_m>,
                         .needs = {"travel_error_m", "travel_error_to_m"}},
             machine_key{.name = "transmission.travel_error_to_m",
                         .rule = detail::rule::any_number,
                         .meaning = "where it ends",
                         .at = member<&transmission_description::travel_error_to_m>,
                         .needs = {"travel_error_m", "travel_error_from_m"}}},
    .prior = {0.4, "screws and racks bend and are ground unevenly; less than a lead that is wrong throughout"},
    .remedy = "Write a pitch table over the travel into the control, or close the loop on the scale.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "a pitch table over the travel in the control";
    },
};

} // namespace quadrant::inline v0::diagnosis::suspect
