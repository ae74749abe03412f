// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../filter/viscous_step.hpp"
#include "law_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace quadrant::inline v0::analysis {

/// How a loop answers a step.
struct step_figures {
    std::vector<quantity<si::length>> response; ///< position at sample 0 (when the step is due), 1, ...
    quantity<si::length> peak{}; ///< largest position, to the side of the step; disturbance: largest magnitude
    quantity<si::time> peak_time{};
    quantity<si::length> rest{}; ///< how far it is from its aim at the end
    std::optional<quantity<si::time>>
        settling;         ///< from when on it stays within 2 % (of the step; of the peak); none: never
    double overshoot = 0; ///< of a reference step, as a share of it
    std::optional<quantity<si::time>> rise; ///< of a reference step, from 10 % to 90 %
};

/// What the test is made with.
template <signal_tag Command = signal::voltage> struct step_options {
    quantity<si::time> lasts = quantity<si::time>::from_value(1);
    quantity_of<Command> limit = quantity_of<Command>::from_value(
        std::numeric_limits<double>::infinity()); ///< of the command; the law is told
};

namespace detail {
/// Any law on the sampled axis: reference and push are steps at sample 0, seen lead() periods before.
template <axis_law Law>
step_figures stepped(Law law, const sampled_axis<typename Law::output>& axis, quantity<si::length> to,
                     quantity_of<typename Law::output> push, const step_options<typename Law::output>& with) {
    using command = quantity_of<typename Law::output>;
    require_positive("step_test.lasts", with.lasts);
    require(with.limit > command(), "step_test.limit", with.limit, "must be above 0 (infinite: none)");
    const double T = axis.period.value(), B = axis.plant.gain.value();
    const viscous_step<> step(axis.plant.viscous_rate.value(), T);
    const auto samples = static_cast<long>(std::lround(with.lasts.value() / T));
    require(samples >= 10, "step_test.lasts", with.lasts, "must be ten periods or more");
    long lead = 0;
    if constexpr (requires { Law::most_lead; }) lead = static_cast<long>(law.lead());
    law.reset();
    double x = 0, v = 0;
    step_figures y;
    for (long k = -lead; k < samples; ++k) {
        if (k >= 0) y.response.push_back(quantity<si::length>::from_value(x));
        const axis_motion<> reference{k + lead >= 0 ? to : quantity<si::length>(), {}, {}};
        const command u =
            law(reference, quantity<si::length>::from_value(x), quantity<si::velocity>::from_value(v));
        const command applied = u > with.limit ? with.limit : u < -with.limit ? -with.limit : u;
        if constexpr (requires { law.applied(applied); }) law.applied(applied);
        const double drive = B * (applied + (k >= 0 ? push : command())).value();
        x += step.gained * v + step.way * drive;
        v = step.kept * v + step.gained * drive;
    }
    return y;
}
inline void find_settling(step_figures& y, double aim, double within, double T) {
    y.rest = y.response.back() - quantity<si::length>::from_value(aim);
    std::size_t k = y.response.size();
    while (k > 0 && std::abs(y.response[k - 1].value() - aim) <= within) --k;
    if (k < y.response.size()) y.settling = quantity<si::time>::from_value(double(k) * T);
}
} // namespace detail

/// Reads the figures of a reference step off its response.
inline void read_reference_step(step_figures& y, quantity<si::length> size, duration period) {
    std::optional<std::size_t> low, high;
    for (std::size_t k = 0; k < y.response.size(); ++k) {
        if (y.response[k] > y.peak) y.peak = y.response[k], y.peak_time = double(k) * period;
        if (!low && y.response[k] >= 0.1 * size) low = k;
        if (!high && y.response[k] >= 0.9 * size) high = k;
    }
    if (low && high) y.rise = double(*high - *low) * period;
    y.overshoot = std::max(0.0, y.peak / size - 1);
    detail::find_settling(y, size.value(), 0.02 * size.value(), period.value());
}

/// The reference jumps by `size` (velocity and acceleration stay 0).
/// Throws "step_test.<field> = ...: must ...".
template <axis_law Law>
step_figures reference_step(const Law& law, const sampled_axis<typename Law::output>& axis,
                            quantity<si::length> size, const step_options<typename Law::output>& with = {}) {
    require_positive("step_test.size", size);
    step_figures y = detail::stepped(law, axis, size, {}, with);
    read_reference_step(y, size, axis.period);
    return y;
}

/// A force comes on, as what it takes of the command to hold against it; the reference stands. Settled: within
/// 2 % of the peak.
template <axis_law Law>
step_figures disturbance_step(const Law& law, const sampled_axis<typename Law::output>& axis,
                              quantity_of<typename Law::output> size,
                              const step_options<typename Law::output>& with = {}) {
    step_figures y = detail::stepped(law, axis, {}, size, with);
    for (std::size_t k = 0; k < y.response.size(); ++k)
        if (std::abs(y.response[k].value()) > y.peak.value())
            y.peak = quantity<si::length>::from_value(std::abs(y.response[k].value())),
            y.peak_time = double(k) * axis.period;
    detail::find_settling(y, 0, 0.02 * y.peak.value(), axis.period.value());
    return y;
}

} // namespace quadrant::inline v0::analysis
