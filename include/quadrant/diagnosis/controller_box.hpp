// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../compose/cascade_p_pi.hpp"
#include "../filter/two_sample_derivative.hpp"
#include "own_controller.hpp"
#include "signals.hpp"

#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace quadrant::diagnosis {

namespace detail {

using filtered_estimate = filtered_derivative<signal::position, signal::velocity>;
using two_sample_estimate = two_sample_derivative<signal::position, signal::velocity>;
using no_notch = through<signal::voltage>;
using command_notch = notch<signal::voltage>;

template <class Estimator, class Notch>
cascade<cascade_p_pi_boxes<Estimator, Notch>> described(const controller_description& c,
                                                        const actuator_description& a, double period) {
    using boxes = cascade_p_pi_boxes<Estimator, Notch>;
    typename boxes::parameters p{
        .position_gain = gain_of<signal::velocity, signal::position>::from_value(c.position_gain_per_s),
        .velocity_gain = gain_of<signal::voltage, signal::velocity>::from_value(c.velocity_gain_V_s_per_m),
        .velocity_integral =
            gain_rate_of<signal::voltage, signal::velocity>::from_value(c.velocity_integral_V_per_m),
        .velocity_feedforward = c.velocity_feedforward,
        .acceleration_feedforward =
            gain_of<signal::voltage, signal::acceleration>::from_value(c.acceleration_feedforward_V_s2_per_m),
        .viscous_feedforward =
            gain_of<signal::voltage, signal::velocity>::from_value(c.viscous_feedforward_V_s_per_m),
        .coulomb_feedforward = quantity_of<signal::voltage>::from_value(c.coulomb_feedforward_V),
        .limit = quantity_of<signal::voltage>::from_value(
            a.limit_V.value_or(std::numeric_limits<double>::infinity()))};
    if constexpr (std::is_same_v<Estimator, filtered_estimate>)
        p.estimator = {.corner = frequency::from_value(c.velocity_filter_Hz)};
    if constexpr (std::is_same_v<Notch, command_notch>)
        p.notch = {.centre = frequency::from_value(c.notch->frequency_Hz), .damping = c.notch->damping};
    if (a.dac_bits && a.dac_range_V)
        p.dac_step = quantity_of<signal::voltage>::from_value(*a.dac_range_V / std::exp2(*a.dac_bits));
    return {.box = {p, duration::from_value(period)}};
}

/// A controller of the user's own on the ports of a cascade, behind it the limit and the DAC that the machine file describes.
struct own_axis {
    using volts = quantity_of<signal::voltage>;
    running_loop loop;
    double limit, dac_step;
    own_axis(const own_control& own, const actuator_description& a)
        : loop(own.made()), limit(a.limit_V.value_or(std::numeric_limits<double>::infinity())),
          dac_step(a.dac_bits && a.dac_range_V ? *a.dac_range_V / std::exp2(*a.dac_bits) : 0) {}

    volts operator()(quantity_of<signal::position> reference, quantity_of<signal::position> measured) {
        const double u = std::clamp(loop(nullptr, reference.value(), measured.value()), -limit, limit);
        return volts::from_value(dac_step > 0 ? std::round(u / dac_step) * dac_step : u);
    }
    void settle(const loop_start& row) { loop(&row, 0, 0); }
};

} // namespace detail

/// Calls f with the cascade that the machine file describes, as a value of its own type.
template <class F>
auto with_cascade(const controller_description& c, const actuator_description& a, double period, F f) {
    using namespace detail;
    if (c.velocity_estimator == controller_description::estimator::two_sample_mean)
        return c.notch ? f(described<two_sample_estimate, command_notch>(c, a, period))
                       : f(described<two_sample_estimate, no_notch>(c, a, period));
    return c.notch ? f(described<filtered_estimate, command_notch>(c, a, period))
                   : f(described<filtered_estimate, no_notch>(c, a, period));
}

/// Calls f with the controller that is described: the machine file's cascade, or the user's own.
template <class F>
auto with_controller(const controller_description& c, const actuator_description& a, double period, F f) {
    return c.own ? f(detail::own_axis(*c.own, a)) : with_cascade(c, a, period, f);
}

/// Puts a controller into the middle of a motion: row 0 of a log is its past, the differences to row 1 its velocities,
/// the command of row 0 fixes the integral (a controller without one starts with none).
template <class Controller>
void start_at_row_0(Controller& axis, double r0, double r1, double y0, double y1, double u0, double period) {
    settle_at(axis, {.reference = r0,
                     .measured = y0,
                     .reference_velocity = (r1 - r0) / period,
                     .measured_velocity = (y1 - y0) / period,
                     .command = u0});
}

/// The controller box alone: fed the logged reference and position, it puts out what the described controller would
/// have commanded. Row 0 is taken from the log. What went before it is unknown, at rest too: the noise of the encoder is in
/// the first command by way of the velocity. What that leaves open of the initial integral is a constant offset of the
/// replay, which a second pass takes from the whole record.
inline std::vector<double> replay_controller(const controller_description& c, const actuator_description& a,
                                             double period, std::span<const double> reference,
                                             std::span<const double> position,
                                             std::span<const double> command) {
    return with_controller(c, a, period, [&](const auto& described) {
        std::vector<double> out(reference.size());
        const auto pass = [&](double start) {
            auto axis = described;
            start_at_row_0(axis, reference[0], reference[1], position[0], position[1], start, period);
            out[0] = command[0];
            for (std::size_t k = 1; k < out.size(); ++k)
                out[k] = axis(quantity_of<signal::position>::from_value(reference[k]),
                              quantity_of<signal::position>::from_value(position[k]))
                             .value();
        };
        pass(command[0]);
        if (c.own || c.velocity_integral_V_per_m != 0) {
            std::vector<double> offset(out.size());
            for (std::size_t k = 0; k < out.size(); ++k) offset[k] = command[k] - out[k];
            pass(command[0] + quantile(offset, 0.5));
        }
        return out;
    });
}

} // namespace quadrant::diagnosis
