// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/pid.hpp"
#include "feed_law.hpp"

namespace quadrant::inline v0::diagnosis::controllers {

inline constexpr auto pid_keys = detail::joined(
    std::array<controller_key, 6>{
        {{.name = "gain_V_per_m",
          .says = "P on the position error",
          .rule = detail::rule::not_negative,
          .needed = true},
         {.name = "integral_gain_V_per_m_s",
          .says = "I on the position error",
          .rule = detail::rule::not_negative,
          .scale_of = "gain_V_per_m"},
         {.name = "derivative_gain_V_s_per_m",
          .says = "D on the velocity error",
          .rule = detail::rule::not_negative},
         {.name = "derivative_corner_Hz",
          .says = "low-pass of the derivative part",
          .rule = detail::rule::positive,
          .otherwise = std::numeric_limits<double>::infinity()},
         {.name = "position_weight", .says = "of the reference in P", .otherwise = 1},
         {.name = "velocity_weight", .says = "of the reference in D", .otherwise = 1}}},
    feed_law_keys);

/// PID of a feed axis: block `pid`.
inline constexpr controller_kind pid{
    .name = "pid",
    .label = "PID of a feed axis",
    .law = "block `pid`",
    .keys = pid_keys,
    .make =
        [](const given_values& v, const actuator_description& a, double period) {
            quadrant::pid<>::parameters p{.gain = in_si(v["gain_V_per_m"]),
                                          .integral_gain = in_si(v["integral_gain_V_per_m_s"]),
                                          .derivative_gain = in_si(v["derivative_gain_V_s_per_m"]),
                                          .position_weight = v["position_weight"],
                                          .velocity_weight = v["velocity_weight"],
                                          .limit = in_si(detail::stage_of(a).limit)};
            if (v.has("derivative_corner_Hz")) p.derivative_corner = in_si(v["derivative_corner_Hz"]);
            return detail::make_feed_loop<quadrant::pid<>, false>(v, a, period, p);
        },
    .motions = true};

} // namespace quadrant::inline v0::diagnosis::controllers
