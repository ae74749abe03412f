// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/lead_lag.hpp"
#include "feed_law.hpp"

namespace quadrant::inline v0::diagnosis::controllers {

inline constexpr auto lead_lag_keys =
    detail::joined(believed_plant_keys,
                   std::array<controller_key, 3>{{
                       {.name = "crossover_Hz",
                        .says = "where the loop has gain one",
                        .rule = detail::rule::positive,
                        .needed = true},
                       {.name = "phase_margin_deg",
                        .says = "at the crossover",
                        .rule = detail::rule::positive,
                        .otherwise = 45},
                       {.name = "integral",
                        .says = "corner of the integral part, over the crossover",
                        .rule = detail::rule::positive,
                        .otherwise = 0.1},
                   }},
                   feed_law_keys);

/// Lead-lag compensator: block `rst`, designed by `design_lead_lag`.
inline constexpr controller_kind lead_lag{
    .name = "lead_lag",
    .label = "lead-lag compensator",
    .law = "block `rst`, designed by `design_lead_lag`",
    .keys = lead_lag_keys,
    .make =
        [](const given_values& v, const actuator_description& a, double period) {
            return detail::make_feed_loop<quadrant::lead_lag<>, true>(
                v, a, period,
                design_lead_lag(detail::believed_plant(v),
                                {in_si(v["crossover_Hz"]), v["phase_margin_deg"], v["integral"]},
                                duration::from_value(period)));
        },
    .motions = true};

} // namespace quadrant::inline v0::diagnosis::controllers
