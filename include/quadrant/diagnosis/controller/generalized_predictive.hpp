// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/generalized_predictive.hpp"
#include "feed_law.hpp"

namespace quadrant::inline v0::diagnosis::controllers {

inline constexpr auto generalized_predictive_keys =
    detail::joined(believed_plant_keys,
                   std::array<controller_key, 1>{{
                       {.name = "effort_m_per_V",
                        .says = "position error that costs as much as a change of the command by one",
                        .rule = detail::rule::positive,
                        .needed = true},
                   }},
                   feed_law_keys);

/// Generalized predictive control, 20 periods ahead: block `rst`, designed by `generalized_predictive`.
inline constexpr controller_kind generalized_predictive{
    .name = "generalized_predictive",
    .label = "generalized predictive control",
    .law = "block `rst`, designed by `generalized_predictive`, 20 periods ahead",
    .keys = generalized_predictive_keys,
    .make =
        [](const given_values& v, const actuator_description& a, double period) {
            return detail::make_feed_loop<generalized_predictive_law<>, true>(
                v, a, period,
                quadrant::generalized_predictive<20>(detail::believed_plant(v),
                                                     predictive_costs<>{.effort = in_si(v["effort_m_per_V"])},
                                                     duration::from_value(period)));
        },
    .motions = true};

} // namespace quadrant::inline v0::diagnosis::controllers
