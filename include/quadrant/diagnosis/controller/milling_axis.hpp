// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "milling_loop.hpp"

namespace quadrant::inline v0::diagnosis::controllers {

inline constexpr std::array<controller_key, 24> milling_axis_keys{
    {{.name = "position_gain_per_s",
      .says = "P of the position loop",
      .rule = detail::rule::not_negative,
      .needed = true},
     {.name = "velocity_gain_V_s_per_m",
      .says = "P of the velocity loop",
      .rule = detail::rule::not_negative,
      .needed = true},
     {.name = "velocity_integral_V_per_m",
      .says = "I of the velocity loop",
      .rule = detail::rule::not_negative,
      .scale_of = "velocity_gain_V_s_per_m"},
     {.name = "velocity_filter_Hz",
      .says = "corner of the filtered derivatives of reference and position",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "acceleration_feedforward_V_s2_per_m", .says = "times the reference acceleration"},
     {.name = "viscous_feedforward_V_s_per_m", .says = "times the reference velocity"},
     {.name = "notch.frequency_Hz",
      .says = "centre of a notch behind both derivatives",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "notch.width",
      .says = "relative width between its -3 dB points",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "observer.corner_Hz",
      .says = "disturbance observer: corner of its filter Q",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "observer.plant_gain_m_per_s2_V",
      .says = "acceleration per command of its nominal plant",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "observer.plant_damping_per_s",
      .says = "viscous friction over mass of its nominal plant",
      .rule = detail::rule::not_negative},
     {.name = "friction.coulomb_V",
      .says = "Maxwell-slip friction of the reference: Coulomb level",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "friction.static_V", .says = "level at rest", .rule = detail::rule::positive, .needed = true},
     {.name = "friction.stribeck_velocity_m_per_s",
      .says = "velocity over which the level falls",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "friction.viscous_V_s_per_m", .says = "viscous part", .rule = detail::rule::not_negative},
     {.name = "friction.gms_weights",
      .says = "share of the level of each element; together 1",
      .rule = detail::rule::positive,
      .needed = true,
      .form = key_form::list,
      .most = 4},
     {.name = "friction.gms_stiffness_V_per_m",
      .says = "stiffness of each element",
      .rule = detail::rule::positive,
      .needed = true,
      .form = key_form::list,
      .most = 4},
     {.name = "friction.gms_attraction_V_per_s",
      .says = "rate at which a slipping element returns to its level",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "memory.cycle_s",
      .says = "repetitive memory: the cycle",
      .rule = detail::rule::positive,
      .needed = true},
     {.name = "memory.weights", .says = "of the last cycles; absent: 1", .form = key_form::list, .most = 3},
     {.name = "memory.learning",
      .says = "taps of its learning filter, the earliest first; absent: 1",
      .form = key_form::list,
      .most = 90},
     {.name = "memory.ahead",
      .says = "how many samples ahead the first of them looks",
      .rule = {"must be a whole number from 0 to 89",
               [](double x) { return x >= 0 && x <= 89 && x == std::floor(x); }},
      .searched = false},
     {.name = "memory.smoothing",
      .says = "taps of its symmetric smoothing filter, an odd number; absent: 1",
      .form = key_form::list,
      .most = 61},
     {.name = "memory.fade_s",
      .says = "of a change of the cycle",
      .rule = detail::rule::not_negative,
      .searched = false}}};

/// The cascade of the milling table: notch in the velocity feedback, disturbance observer, friction, memory.
inline constexpr controller_kind milling_axis{
    .name = "milling_axis",
    .label = "cascade of the milling table",
    .law = "block `milling_axis`",
    .keys = milling_axis_keys,
    .make = [](const given_values& v, const actuator_description& a,
               double period) -> std::unique_ptr<running_controller> {
        const duration T = duration::from_value(period);
        using none = absent<signal::position, signal::voltage>;
        using observer = disturbance_observer<signal::voltage>;
        if (!v.has_box("observer"))
            return std::make_unique<detail::milling_loop<none>>(v, a, period, none({}, T));
        return std::make_unique<detail::milling_loop<observer>>(
            v, a, period,
            observer({.corner = in_si(v["observer.corner_Hz"]),
                      .plant = axis_model<signal::voltage>{in_si(v["observer.plant_gain_m_per_s2_V"]),
                                                           in_si(v["observer.plant_damping_per_s"])}},
                     T));
    },
    .examine =
        [](const given_values& v, const auto& refuse, const auto&) {
            const auto weights = v.list("friction.gms_weights");
            if (weights.size() != v.list("friction.gms_stiffness_V_per_m").size())
                refuse("friction.gms_stiffness_V_per_m", "must have one entry for each of gms_weights");
            const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
            if (!weights.empty() && std::abs(sum - 1) > 1e-3)
                refuse("friction.gms_weights", "must add up to 1: shares of the friction level");
            if (v["friction.static_V"] < v["friction.coulomb_V"])
                refuse("friction.static_V", "must not lie below coulomb_V");
            if (const auto taps = v.list("memory.smoothing"); !taps.empty() && taps.size() % 2 == 0)
                refuse("memory.smoothing", "must have an odd number of entries");
        },
    .viscous = {"viscous_feedforward_V_s_per_m"},
    .acceleration = {"acceleration_feedforward_V_s2_per_m"},
    .motions = true};

} // namespace quadrant::inline v0::diagnosis::controllers
