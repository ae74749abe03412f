// SPDX-License-Identifier: BSL-1.0
// One axis in the frequency and the time domain: its linear part by pulses, itself by a step.
#include "analyse_axis.hpp"

#include "contour_plot.hpp"
#include "law_of_drive.hpp"
#include "linear_loop.hpp"
#include "measured_loop.hpp"
#include "propose.hpp"

#include <fmt/format.h>
#include <quadrant/analysis/nyquist.hpp>

namespace quadrant_cnc {

namespace an = quadrant::analysis;

namespace {

/// Newtons at the table that one volt of the command makes.
double force_a_volt(const axis_description& a) {
    if (const auto* d = std::get_if<ball_screw_description>(&a.drive))
        return d->amplifier_A_per_V * d->torque_constant_Nm_per_A / pitch_per_radian(*d);
    return std::get<linear_motor_description>(a.drive).force_constant_N_per_V;
}

template <class Loop> void read_tracking(axis_analysis& out, const Loop& loop, frequency highest) {
    std::optional<double> before;
    for (const response_line& l : out.lines) {
        if (l.frequency_Hz > highest.value()) break;
        const double size = std::abs(l.tracking);
        if (size > out.tracking_peak) out.tracking_peak = size, out.tracking_peak_Hz = l.frequency_Hz;
        if (!out.bandwidth_Hz && before && size < std::numbers::sqrt2 / 2) {
            const auto below = [&](frequency f) {
                return std::abs(loop.tracking(f)) < std::numbers::sqrt2 / 2;
            };
            out.bandwidth_Hz = an::detail::bisect(below, an::hertz(*before), an::hertz(l.frequency_Hz)).value();
        }
        before = l.frequency_Hz;
    }
}

template <class Loop>
void read_lines(axis_analysis& out, const Loop& loop, const an::band& lines, frequency highest) {
    for (const frequency& f : an::grid(lines))
        out.lines.push_back(
            {f.value(), loop.open(f), loop.sensitivity(f), f <= highest ? loop.tracking(f) : an::complex()});
    read_tracking(out, loop, highest);
}

/// The law of the loop that runs around a measured axis.
void read_measured(axis_analysis& out, const an::impulse_test& model, const frf_file& measured) {
    const measured_loop loop(model, measured.frf.response());
    const an::band band = loop.band();
    an::band drawn = band;
    drawn.per_decade = 150;
    read_lines(out, loop, drawn, model.highest());
    out.figures = an::band_figures(loop, band);
    out.measured = measured_axis{measured.file,    measured.frf.lines.size(), measured.from_Hz(),
                                 measured.to_Hz(), measured.coherence,        measured.frf.lines};
    const double end = std::abs(an::complex(loop.open(band.to)));
    if (!(end < 1)) {
        out.measured->not_told = fmt::format("the open loop's gain is still {:.3g} at its end, {:.4g} Hz: measure "
                                             "further up, to where it is below 1",
                                             end, band.to.value());
        return;
    }
    try {
        // Two integrators: the phase begins between 0 and -360 deg, whether the law has one or not.
        out.stable = an::unstable_poles([&](frequency f) { return loop.open(f); }, band, 2) == 0;
    } catch (const quadrant::invalid_parameter& fault) {
        out.measured->not_told = fault.what();
    }
}

/// The reference jumps; until it is settled for as long as that took, or ten seconds.
an::step_figures stepped(axis_loop& loop, double period, double size, double* most_command,
                         std::size_t* limited) {
    an::step_figures y;
    loop.rest();
    const auto most = static_cast<std::size_t>(10 / period);
    const std::size_t lead = loop.lead();
    std::size_t away = 0;
    for (std::size_t k = 0; k < most + lead; ++k) {
        const an::loop_sample s = loop.step({in_si(size), {}, {}}, 0);
        if (most_command) *most_command = std::max(*most_command, std::abs(s.command));
        if (limited) *limited += loop.limited();
        if (k < lead) continue;
        y.response.push_back(quantity<si::length>::from_value(s.position));
        if (!std::isfinite(s.position) || std::abs(s.position) > 1e3 * std::abs(size)) break;
        if (std::abs(s.position - size) > 0.02 * size) away = k;
        if (k > 100 + lead && k > 3 * away) break;
    }
    an::read_reference_step(y, in_si(size), in_si(period));
    return y;
}

} // namespace

bool step_answer::differs() const {
    return std::abs(as_it_is.overshoot - linear.overshoot) > 0.01 ||
           as_it_is.settling.has_value() != linear.settling.has_value();
}

axis_analysis analyse_axis(const axis_description& a, double period, std::uint64_t seed, double step_m,
                           const frf_file* measured) {
    axis_analysis out;
    out.name = a.name();
    out.law = a.law.kind;
    out.period = period;
    axis_loop linear(linear_part(a), period, seed, measured ? seen::by_encoder : seen::at_table),
        real(a, period, seed);
    constexpr double metre = 1e-6;
    double command_a_step = 0;
    stepped(linear, period, metre, &command_a_step, nullptr);
    const double volt = command_a_step > 0 && std::isfinite(command_a_step) ? command_a_step : 1;
    const an::impulse_test test(linear, in_si(period), volt, metre);
    out.stable = test.decays();
    out.linear = test.linear();
    if (out.stable && out.linear) {
        if (measured) {
            read_measured(out, test, *measured);
            out.measured->proposed = propose(*measured, a, period);
        } else {
            const frequency from = 2e-4 * test.nyquist();
            read_lines(out, test, {from, 0.999 * test.nyquist(), 150}, test.highest());
            out.figures = an::frequency_figures(test, from, test.nyquist());
        }
        out.stiffness_N_per_m = out.figures.softest.value * force_a_volt(a);
        out.stiffness_Hz = out.figures.softest.at.value();
    }
    out.step.size_m = step_m > 0 ? step_m : round_down(0.5 * a.command.limit_V * metre / volt);
    out.step.linear = stepped(linear, period, out.step.size_m, nullptr, nullptr);
    out.step.as_it_is = stepped(real, period, out.step.size_m, nullptr, &out.step.limited);
    return out;
}

} // namespace quadrant_cnc
