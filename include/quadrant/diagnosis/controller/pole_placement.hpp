// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/pole_placement.hpp"
#include "../../control/zero_phase_tracking.hpp"
#include "feed_law.hpp"

namespace quadrant::inline v0::diagnosis::controllers {

inline constexpr auto pole_placement_keys = detail::joined(
    believed_plant_keys,
    std::array<controller_key, 3>{{
        {.name = "natural_Hz",
         .says = "of the pair of poles of the loop",
         .rule = detail::rule::positive,
         .needed = true},
        {.name = "damping", .says = "of that pair", .rule = detail::rule::positive, .otherwise = 1},
        {.name = "observer_Hz", .says = "of the other poles", .rule = detail::rule::positive, .needed = true},
    }},
    feed_law_keys);

inline rst_poles poles_of(const given_values& v) {
    return {in_si(v["natural_Hz"]), v["damping"], in_si(v["observer_Hz"])};
}

/// Poles of the loop where they are wanted: block `rst`, designed by `place_rst`.
inline constexpr controller_kind pole_placement{
    .name = "pole_placement",
    .label = "pole placement",
    .law = "block `rst`, designed by `place_rst`",
    .keys = pole_placement_keys,
    .make =
        [](const given_values& v, const actuator_description& a, double period) {
            return detail::make_feed_loop<quadrant::pole_placement<>, true>(
                v, a, period, place_rst(detail::believed_plant(v), poles_of(v), duration::from_value(period)));
        },
    .motions = true};

/// The same feedback with zero phase error tracking: block `rst`, designed by `zero_phase_rst`.
inline constexpr controller_kind zero_phase{
    .name = "zero_phase",
    .label = "zero phase error tracking",
    .law = "block `rst`, designed by `zero_phase_rst`",
    .keys = pole_placement_keys,
    .make =
        [](const given_values& v, const actuator_description& a, double period) {
            return detail::make_feed_loop<zero_phase_tracking<>, true>(
                v, a, period,
                zero_phase_rst(detail::believed_plant(v), poles_of(v), duration::from_value(period)));
        },
    .motions = true};

} // namespace quadrant::inline v0::diagnosis::controllers
