// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/state_feedback.hpp"
#include "feed_law.hpp"

namespace quadrant::inline v0::diagnosis::controllers {

inline constexpr auto state_feedback_keys =
    detail::joined(believed_plant_keys,
                   std::array<controller_key, 4>{{
                       {.name = "position_gain_V_per_m",
                        .says = "of the position error",
                        .rule = detail::rule::positive,
                        .needed = true},
                       {.name = "velocity_gain_V_s_per_m",
                        .says = "of the velocity error",
                        .rule = detail::rule::not_negative,
                        .needed = true},
                       {.name = "encoder_noise_m",
                        .says = "standard deviation of a reading, for the observer",
                        .rule = detail::rule::positive,
                        .needed = true},
                       {.name = "drift_V",
                        .says = "deviation that the disturbance gathers in a second, for the observer",
                        .rule = detail::rule::positive,
                        .needed = true},
                   }},
                   feed_law_keys);

/// Feedback of estimated states with the disturbance cancelled: block `state_feedback`.
inline constexpr controller_kind state_feedback{
    .name = "state_feedback",
    .label = "state feedback with observer",
    .law = "block `state_feedback`",
    .keys = state_feedback_keys,
    .make =
        [](const given_values& v, const actuator_description& a, double period) {
            return detail::make_feed_loop<quadrant::state_feedback<>, true>(
                v, a, period,
                {.plant = detail::believed_plant(v),
                 .position_gain = in_si(v["position_gain_V_per_m"]),
                 .velocity_gain = in_si(v["velocity_gain_V_s_per_m"]),
                 .encoder_noise = in_si(v["encoder_noise_m"]),
                 .drift = in_si(v["drift_V"])});
        },
    .motions = true};

} // namespace quadrant::inline v0::diagnosis::controllers
