// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/sliding_mode.hpp"
#include "feed_law.hpp"

namespace quadrant::inline v0::diagnosis::controllers {

inline constexpr auto sliding_mode_keys =
    detail::joined(believed_plant_keys,
                   std::array<controller_key, 3>{{
                       {.name = "sliding_per_s",
                        .says = "rate at which an error dies out on the surface",
                        .rule = detail::rule::positive,
                        .needed = true},
                       {.name = "gain_V_s_per_m",
                        .says = "gain on the distance from the surface",
                        .rule = detail::rule::not_negative,
                        .needed = true},
                       {.name = "adaptation_V_per_m",
                        .says = "of the estimated disturbance",
                        .rule = detail::rule::not_negative,
                        .needed = true},
                   }},
                   feed_law_keys);

/// Sliding mode with an adapted disturbance: block `sliding_mode`.
inline constexpr controller_kind sliding_mode{
    .name = "sliding_mode",
    .label = "sliding mode",
    .law = "block `sliding_mode`",
    .keys = sliding_mode_keys,
    .make =
        [](const given_values& v, const actuator_description& a, double period) {
            return detail::make_feed_loop<quadrant::sliding_mode<>, false>(
                v, a, period,
                {.plant = detail::believed_plant(v),
                 .sliding = in_si(v["sliding_per_s"]),
                 .gain = in_si(v["gain_V_s_per_m"]),
                 .adaptation = in_si(v["adaptation_V_per_m"]),
                 .limit = in_si(detail::stage_of(a).limit)});
        },
    .motions = true};

} // namespace quadrant::inline v0::diagnosis::controllers
