// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../filter/two_sample_derivative.hpp"
#include "../../loop/cascade_p_pi.hpp"
#include "../machine/own_controller.hpp"
#include "kind.hpp"

#include <type_traits>

namespace quadrant::inline v0::diagnosis {

namespace detail {

using filtered_estimate = filtered_derivative<signal::position, signal::velocity>;
using two_sample_estimate = two_sample_derivative<signal::position, signal::velocity>;
using no_notch = through<signal::voltage>;
using command_notch = notch<signal::voltage>;

template <class Estimator, class Notch>
cascade<cascade_p_pi_boxes<Estimator, Notch>> described_cascade(const given_values& v,
                                                                const actuator_description& a, double period) {
    using boxes = cascade_p_pi_boxes<Estimator, Notch>;
    const output_stage out = stage_of(a);
    typename boxes::parameters p{.position_gain = in_si(v["position_gain_per_s"]),
                                 .velocity_gain = in_si(v["velocity_gain_V_s_per_m"]),
                                 .velocity_integral = in_si(v["velocity_integral_V_per_m"]),
                                 .velocity_feedforward = v["velocity_feedforward"],
                                 .acceleration_feedforward = in_si(v["acceleration_feedforward_V_s2_per_m"]),
                                 .viscous_feedforward = in_si(v["viscous_feedforward_V_s_per_m"]),
                                 .coulomb_feedforward = in_si(v["coulomb_feedforward_V"]),
                                 .limit = in_si(out.limit),
                                 .dac_step = in_si(out.dac_step)};
    if constexpr (std::is_same_v<Estimator, filtered_estimate>)
        p.estimator = {.corner = in_si(v["velocity_filter_Hz"])};
    if constexpr (std::is_same_v<Notch, command_notch>)
        p.notch = {.centre = in_si(v["notch.frequency_Hz"]), .width = v["notch.width"]};
    return {.box = {p, duration::from_value(period)}};
}

/// A loop of quadrant that reads positions only, and what starts it.
template <class Loop> struct stock_loop {
    Loop loop;
    bool integral;
    double step(double reference, double measured) {
        return loop(quantity_of<signal::position>::from_value(reference),
                    quantity_of<signal::position>::from_value(measured))
            .value();
    }
    void settle(const loop_start& row) { settle_at(loop, row); }
    bool remembers() const { return integral; }
    bool limited() const { return loop.limited(); }
    bool faulted() const { return loop.faulted(); }
};

} // namespace detail

namespace controllers {

using detail::rule::any_number;
using detail::rule::not_negative;
using detail::rule::positive;

inline constexpr std::array<controller_key, 11> cascade_p_pi_keys{
    {{.name = "position_gain_per_s", .says = "P of the position loop", .rule = not_negative, .needed = true},
     {.name = "velocity_gain_V_s_per_m",
      .says = "P of the velocity loop",
      .rule = not_negative,
      .needed = true},
     {.name = "velocity_integral_V_per_m",
      .says = "I of the velocity loop",
      .rule = not_negative,
      .scale_of = "velocity_gain_V_s_per_m"},
     {.name = "velocity_feedforward", .says = "share of the reference velocity in the demand", .scale = 0.1},
     {.name = "acceleration_feedforward_V_s2_per_m", .says = "times the reference acceleration"},
     {.name = "viscous_feedforward_V_s_per_m", .says = "times the reference velocity"},
     {.name = "coulomb_feedforward_V", .says = "times the sign of the reference velocity"},
     {.name = "velocity_filter_Hz",
      .says = "corner of the filtered derivative, which needs it",
      .rule = positive,
      .otherwise = std::numeric_limits<double>::infinity(),
      .needed_with = "velocity_estimator"},
     {.name = "notch.frequency_Hz", .says = "centre of a notch behind PI", .rule = positive, .needed = true},
     {.name = "notch.width",
      .says = "relative width between its -3 dB points",
      .rule = positive,
      .needed = true,
      .old_name = "damping"},
     {.name = "velocity_estimator",
      .says = "how the velocity comes from positions",
      .form = key_form::word,
      .words = {"filtered_derivative", "two_sample_mean"}}}};

} // namespace controllers

/// Calls f with the cascade that the machine file describes, as a value of its own type.
template <class F> auto with_cascade(const given_values& v, const actuator_description& a, double period, F f) {
    using namespace detail;
    const bool notched = v.has_box("notch");
    if (v["velocity_estimator"] == 1)
        return notched ? f(described_cascade<two_sample_estimate, command_notch>(v, a, period))
                       : f(described_cascade<two_sample_estimate, no_notch>(v, a, period));
    return notched ? f(described_cascade<filtered_estimate, command_notch>(v, a, period))
                   : f(described_cascade<filtered_estimate, no_notch>(v, a, period));
}

namespace controllers {

/// P on position, PI on velocity, notch, feedforward: `cascade` of the library.
inline constexpr controller_kind cascade_p_pi{
    .name = "cascade_p_pi",
    .label = "cascade of P and PI",
    .law =
        "u = notch(PI(position_gain (r - y) + velocity_feedforward v_ref - v)) + feedforwards; block `cascade`",
    .keys = cascade_p_pi_keys,
    .make = [](const given_values& v, const actuator_description& a,
               double period) -> std::unique_ptr<running_controller> {
        return with_cascade(v, a, period, [&](auto loop) -> std::unique_ptr<running_controller> {
            using stock = detail::stock_loop<decltype(loop)>;
            return std::make_unique<detail::positions_only<stock>>(
                stock{std::move(loop), v["velocity_integral_V_per_m"] != 0});
        });
    },
    .coulomb = {"coulomb_feedforward_V"},
    .viscous = {"viscous_feedforward_V_s_per_m"},
    .acceleration = {"acceleration_feedforward_V_s2_per_m"}};

} // namespace controllers

/// The same for a description of this kind.
template <class F>
auto with_cascade(const controller_description& c, const actuator_description& a, double period, F f) {
    return with_cascade(given_values(controllers::cascade_p_pi, c), a, period, f);
}

} // namespace quadrant::inline v0::diagnosis
