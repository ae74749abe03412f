// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "margins.hpp"
#include "step_test.hpp"

#include <complex>
#include <optional>
#include <vector>

namespace quadrant::inline v0::analysis {

/// What is usually asked of one axis under a control law.
struct law_figures {
    stability_margins margins;          ///< of the loop opened at the command
    std::optional<double> gain_rise;    ///< by how much the gain may rise until the loop is unstable [dB]
    std::optional<double> gain_fall;    ///< by how much it may fall [dB]
    std::optional<margin> phase;        ///< the smallest phase margin [deg]
    double sensitivity_peak = 0;        ///< max |1/(1 + L)|
    std::optional<frequency> bandwidth; ///< where the sensitivity comes up through -3 dB
    margin softest{}; ///< |1/disturbance| at its least: the command that moves the axis by 1 m
    step_figures reference, disturbance; ///< a step of 1 mm; of a command of 1
    bool settles = false; ///< both steps die out in the time of the test: a loop that is not stable does not
};

namespace detail {
inline void take_gain(law_figures& y, double decibels) {
    if (decibels > 0 && (!y.gain_rise || decibels < *y.gain_rise)) y.gain_rise = decibels;
    if (decibels < 0 && (!y.gain_fall || -decibels < *y.gain_fall)) y.gain_fall = -decibels;
}
} // namespace detail

/// What a band says of a loop with open(f), sensitivity(f) and disturbance(f), such as one around a measured
/// axis; the steps stay empty. Throws for a band that is none.
template <class Loop> law_figures band_figures(const Loop& loop, const band& searched) {
    const auto open = [&](frequency f) { return loop.open(f); };
    law_figures y{margins(open, searched), {}, {}, {}, 0, {}, {}, {}, {}};
    for (const margin& m : y.margins.gain_crossings) detail::take_gain(y, m.value);
    y.phase = y.margins.smallest_phase();
    y.sensitivity_peak = 1 / y.margins.modulus.value;
    y.bandwidth = sensitivity_bandwidth([&](frequency f) { return loop.sensitivity(f); }, searched);
    y.softest = least([&](frequency f) { return 1.0 / loop.disturbance(f); }, searched);
    return y;
}

/// What frequency says of a loop with open(f), sensitivity(f) and disturbance(f), such as `law_loop` and
/// `impulse_test`, up to half its rate; the steps stay empty. At half the sampling rate L is real: that counts
/// as a crossing of the phase when it is negative there.
/// Source: [Franklin1998]. Throws for a band that is none.
template <class Loop> law_figures frequency_figures(const Loop& loop, frequency from, frequency nyquist) {
    law_figures y = band_figures(loop, {from, 0.999 * nyquist});
    const complex last = loop.open(nyquist);
    if (last.real() < 0) detail::take_gain(y, -decibel(std::abs(last)));
    return y;
}

/// All of it at once, for any linear law in the port: frequency response, margins, bandwidth, steps.
/// Source: [Yeung2006] section 3 (analysis of the axis control), [Franklin1998].
/// Throws for a band that is none; a law that is not stable is analysed and reported by `settles`.
template <class Law>
law_figures analysed(const law_loop<Law>& loop, frequency from = hertz(0.5),
                     const step_options<typename Law::output>& steps = {}) {
    law_figures y = frequency_figures(loop, from, 0.5 * once_per(loop.axis.period));
    y.reference = reference_step(loop.law, loop.axis, quantity<si::length>::from_value(1e-3), steps);
    y.disturbance =
        disturbance_step(loop.law, loop.axis, quantity_of<typename Law::output>::from_value(1), steps);
    y.settles = y.reference.settling && y.disturbance.settling;
    return y;
}

} // namespace quadrant::inline v0::analysis
