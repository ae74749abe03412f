// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/predictive.hpp"
#include "feed_law.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

inline constexpr std::size_t longest_horizon = 32;
inline constexpr number_rule whole_horizon{"must be a whole number from 1 to 32",
                                           [](double x) { return x >= 1 && x <= 32 && x == std::floor(x); }};

} // namespace detail

namespace controllers {

inline constexpr auto predictive_keys = detail::joined(
    believed_plant_keys,
    std::array<controller_key, 6>{{
        {.name = "position_error_m",
         .says = "position error that costs as much as the other two",
         .rule = detail::rule::positive,
         .needed = true},
        {.name = "velocity_error_m_per_s",
         .says = "velocity error that costs as much; absent: the velocity costs nothing",
         .rule = detail::rule::positive,
         .otherwise = std::numeric_limits<double>::infinity()},
        {.name = "increment_V",
         .says = "change of the command that costs as much",
         .rule = detail::rule::positive,
         .needed = true},
        {.name = "horizon",
         .says = "periods that are planned ahead",
         .rule = detail::whole_horizon,
         .otherwise = 10,
         .searched = false},
        {.name = "kalman.encoder_noise_m",
         .says = "Kalman filter in place of the measured velocity: standard deviation of a reading",
         .rule = detail::rule::positive,
         .needed = true},
        {.name = "kalman.drift_V",
         .says = "deviation that the disturbance gathers in a second",
         .rule = detail::rule::positive,
         .needed = true},
    }},
    feed_law_keys);

/// The predictive law of the precision stage: block `predictive`.
inline constexpr controller_kind predictive{
    .name = "predictive",
    .label = "predictive control of a stage",
    .law = "block `predictive`, weights by `bryson_weights`",
    .keys = predictive_keys,
    .make = [](const given_values& v, const actuator_description& a,
               double period) -> std::unique_ptr<running_controller> {
        using law = quadrant::predictive<detail::longest_horizon>;
        using position = quantity_of<signal::position>;
        const law::parameters p{.plant = detail::believed_plant(v),
                                .weights = bryson_weights<signal::voltage>(
                                    position::from_value(v["position_error_m"]),
                                    quantity_of<signal::velocity>::from_value(v["velocity_error_m_per_s"]),
                                    quantity_of<signal::voltage>::from_value(v["increment_V"])),
                                .horizon = static_cast<std::size_t>(v["horizon"])};
        const auto made = [&](const actuator_description& out) {
            auto loop = std::make_unique<detail::feed_loop<law, true>>(v, out, period, p);
            if (v.has_box("kalman")) // of a mass of 1: volts and accelerations are all that counts
                loop->estimate_by({.mass = in_si(1.0),
                                   .force_constant = in_si(v["plant_gain_m_per_s2_V"]),
                                   .viscous = in_si(v["plant_damping_per_s"]),
                                   .encoder_noise = in_si(v["kalman.encoder_noise_m"]),
                                   .drift = in_si(v["plant_gain_m_per_s2_V"] * v["kalman.drift_V"])},
                                  period);
            return loop;
        };
        auto loop = made(a);
        loop->told_always(made({})->grows());
        return loop;
    },
    .motions = true};

} // namespace controllers
} // namespace quadrant::inline v0::diagnosis
