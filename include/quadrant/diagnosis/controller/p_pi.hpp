// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/p_pi.hpp"
#include "feed_law.hpp"

namespace quadrant::inline v0::diagnosis::controllers {

inline constexpr auto p_pi_keys = detail::joined(
    std::array<controller_key, 5>{
        {{.name = "position_gain_per_s",
          .says = "P of the position loop",
          .rule = detail::rule::not_negative,
          .needed = true},
         {.name = "gain_V_s_per_m",
          .says = "P of the velocity loop",
          .rule = detail::rule::not_negative,
          .needed = true},
         {.name = "integral_gain_V_per_m",
          .says = "I of the velocity loop",
          .rule = detail::rule::not_negative,
          .scale_of = "gain_V_s_per_m"},
         {.name = "velocity_weight", .says = "share of the reference velocity in the demand", .otherwise = 1},
         {.name = "acceleration_gain_V_s2_per_m", .says = "times the reference acceleration"}}},
    feed_law_keys);

/// P on position, PI on the measured velocity: block `p_pi`.
inline constexpr controller_kind p_pi{
    .name = "p_pi",
    .label = "P and PI of a feed axis",
    .law = "block `p_pi`",
    .keys = p_pi_keys,
    .make =
        [](const given_values& v, const actuator_description& a, double period) {
            return detail::make_feed_loop<quadrant::p_pi<>, false>(
                v, a, period,
                {.position_gain = in_si(v["position_gain_per_s"]),
                 .gain = in_si(v["gain_V_s_per_m"]),
                 .integral_gain = in_si(v["integral_gain_V_per_m"]),
                 .velocity_weight = v["velocity_weight"],
                 .acceleration_gain = in_si(v["acceleration_gain_V_s2_per_m"]),
                 .limit = in_si(detail::stage_of(a).limit)});
        },
    .acceleration = {"acceleration_gain_V_s2_per_m"},
    .motions = true};

} // namespace quadrant::inline v0::diagnosis::controllers
