// SPDX-License-Identifier: BSL-1.0
// Notch and gains of a cascade for a measured axis.
#include "propose.hpp"

#include <quadrant/analysis/gain_design.hpp>
#include <quadrant/analysis/notch_design.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/filter/two_sample_derivative.hpp>

#include <functional>

namespace quadrant_cnc {

namespace an = quadrant::analysis;
namespace signal = quadrant::signal;
using quadrant::frequency;

namespace {

using estimate = std::function<an::complex(frequency)>;

/// Velocity over position as the cascade of the file estimates it; for another law a filtered derivative.
estimate velocity_of(const axis_description& a, double period, proposal& out) {
    const auto T = quadrant::in_si(period);
    const bool cascade = a.law.kind == "cascade_p_pi";
    if (cascade && a.law.number("velocity_estimator", 0) == 1) {
        out.estimator = "two_sample_mean";
        const quadrant::two_sample_derivative<signal::position, signal::velocity> block({}, T);
        return [block](frequency f) { return block.response(f); };
    }
    out.estimator = "filtered_derivative";
    constexpr double share_of_the_rate = 0.15;
    out.velocity_filter_Hz =
        cascade ? a.law.number("velocity_filter_Hz", share_of_the_rate / period) : share_of_the_rate / period;
    const quadrant::filtered_derivative<signal::position, signal::velocity> block(
        {.corner = an::hertz(out.velocity_filter_Hz)}, T);
    return [block](frequency f) { return block.response(f); };
}

} // namespace

proposal propose(const frf_file& measured, const axis_description& a, double period) {
    proposal out;
    const an::gain_design_options wanted;
    out.wanted = {wanted.velocity.gain, wanted.velocity.phase, wanted.velocity.modulus};
    const estimate velocity = velocity_of(a, period, out);
    try {
        const an::tabulated_response axis =
            measured.frf.response(frequency(), an::hertz(0.5 / period), least_coherence);
        const auto design = [&](const estimate& plant) {
            const auto found = an::design_gains<>(plant, velocity, axis.all(100), wanted);
            out.gains = proposed_gains{.velocity_gain = found.velocity.gain.value(),
                                       .velocity_integral = found.velocity.integral_gain.value(),
                                       .position_gain = found.position_gain.value(),
                                       .velocity_limit = an::text(found.velocity_loop.limited_by),
                                       .velocity_limit_Hz = found.velocity_loop.at.value(),
                                       .position_limit = an::text(found.position_loop.limited_by),
                                       .position_limit_Hz = found.position_loop.at.value()};
            return found.velocity_loop.margins.phase_crossings;
        };
        const auto crossings = design(axis);
        if (crossings.empty()) return out;
        const frequency crossover = crossings.front().at;
        try {
            const auto found = an::design_notch<signal::voltage>(
                measured.frf, quadrant::in_si(period),
                {.above = crossover, .crossover = crossover, .least_coherence = least_coherence});
            const quadrant::notch<signal::voltage> block(found.parameters, quadrant::in_si(period));
            const proposed_gains without = *out.gains;
            design([&](frequency f) { return axis(f) * block.response(f); });
            if (out.gains->velocity_gain > without.velocity_gain)
                out.notch = proposed_notch{.frequency_Hz = found.parameters.centre.value(),
                                           .width = found.parameters.width,
                                           .prominence_dB = found.prominence_db,
                                           .without = without.velocity_gain};
            else
                out.gains = without, out.no_notch = "a notch at the highest peak would not let the gain rise";
        } catch (const quadrant::invalid_parameter& fault) {
            out.no_notch = fault.what();
        }
    } catch (const quadrant::invalid_parameter& fault) {
        out.no_gains = fault.what();
    }
    return out;
}

} // namespace quadrant_cnc
