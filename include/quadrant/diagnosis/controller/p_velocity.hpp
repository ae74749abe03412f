// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "kind.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// P on position with the velocity of the reference fed forward, in the unit of the command.
struct p_velocity_loop {
    double gain, feedforward, period;
    output_stage out;
    double last = 0; ///< reference of the row before

    double step(double reference, double measured) {
        const double velocity = (reference - last) / period;
        last = reference;
        return out(gain * (reference - measured) + feedforward * velocity);
    }
    void settle(const loop_start& row) { last = row.reference; }
    bool remembers() const { return false; }
    bool limited() const { return false; }
    bool faulted() const { return false; }
};

} // namespace detail

namespace controllers {

inline constexpr std::array<controller_key, 2> p_velocity_keys{{
    {.name = "position_gain_V_per_m",
     .says = "command per position error",
     .rule = detail::rule::not_negative,
     .needed = true},
    {.name = "velocity_feedforward_V_s_per_m", .says = "command per reference velocity"},
}};

/// The law of most velocity drives: a demand from position error and reference velocity.
inline constexpr controller_kind p_velocity{
    .name = "p_velocity",
    .label = "P on position with velocity feedforward",
    .law = "u = position_gain (r - y) + velocity_feedforward v_ref",
    .keys = p_velocity_keys,
    .make = [](const given_values& v, const actuator_description& a,
               double period) -> std::unique_ptr<running_controller> {
        return std::make_unique<detail::positions_only<detail::p_velocity_loop>>(detail::p_velocity_loop{
            v["position_gain_V_per_m"], v["velocity_feedforward_V_s_per_m"], period, detail::stage_of(a)});
    },
    .viscous = {"velocity_feedforward_V_s_per_m"}};

} // namespace controllers
} // namespace quadrant::inline v0::diagnosis
