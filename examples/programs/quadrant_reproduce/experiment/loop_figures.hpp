// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../thesis.hpp"

#include <quadrant/analysis/margins.hpp>

#include <limits>

namespace thesis {

/// What the thesis says of an axis' loops, in its units; NaN where there is none. Of several crossings the
/// margin nearest to -1. Bandwidths are those of eq. (2.33), of the velocity loop those of 1/(1 + L_v).
struct loop_figures {
    double velocity_gain_margin, velocity_gain_margin_at;   ///< [dB], [Hz]
    double velocity_phase_margin, velocity_phase_margin_at; ///< [deg], [Hz]
    double velocity_bandwidth;                              ///< [Hz]
    double position_gain_margin, position_gain_margin_at;
    double position_phase_margin, position_phase_margin_at;
    double position_bandwidth;
    double tracking_ratio_10Hz;                                                  ///< |1 - T| at 10 Hz
    double min_dynamic_stiffness;                                                ///< [N/um]
    double velocity_closed_bandwidth = std::numeric_limits<double>::quiet_NaN(); ///< [Hz], of eq. (2.26)
    double position_closed_bandwidth = std::numeric_limits<double>::quiet_NaN(); ///< [Hz], of eq. (2.31)
};

inline const analysis::band servo{0.5_Hz, 900_Hz};

/// Where a closed loop falls through -3 dB for the first time [Hz]; NaN where it does not.
template <class Response> double falls_through(const Response& closed, const analysis::band& b) {
    const auto above = [&](frequency f) { return std::abs(closed(f)) > std::sqrt(0.5); };
    const auto lines = analysis::grid(b);
    for (std::size_t i = 1; i < lines.size(); ++i) {
        if (!above(lines[i - 1]) || above(lines[i])) continue;
        frequency low = lines[i - 1], high = lines[i];
        for (int step = 0; step < 40; ++step) {
            const frequency middle = 0.5 * (low + high);
            (above(middle) ? low : high) = middle;
        }
        return low.value();
    }
    return std::numeric_limits<double>::quiet_NaN();
}

/// Of a `p_pi_loop` or a `p_pi_dob_loop`.
template <class Loop>
loop_figures figures_of(const Loop& loop, gain_of<signal::force, signal::voltage> kf,
                        const analysis::band& b = servo) {
    const auto value = [](const auto& m) { return m ? m->value : std::numeric_limits<double>::quiet_NaN(); };
    const auto at = [](const auto& m) { return m ? m->at.value() : std::numeric_limits<double>::quiet_NaN(); };
    const auto hz = [](const auto& f) { return f ? f->value() : std::numeric_limits<double>::quiet_NaN(); };
    const auto v = analysis::margins([&](frequency f) { return loop.open_velocity(f); }, b),
               p = analysis::margins([&](frequency f) { return loop.open_position(f); }, b);
    return {value(v.smallest_gain()),
            at(v.smallest_gain()),
            value(v.smallest_phase()),
            at(v.smallest_phase()),
            hz(analysis::sensitivity_bandwidth([&](frequency f) { return loop.velocity_sensitivity(f); }, b)),
            value(p.smallest_gain()),
            at(p.smallest_gain()),
            value(p.smallest_phase()),
            at(p.smallest_phase()),
            hz(analysis::sensitivity_bandwidth([&](frequency f) { return loop.sensitivity(f); }, b)),
            std::abs(loop.error_ratio(10_Hz)),
            analysis::least([&](frequency f) { return loop.dynamic_stiffness(f, kf); }, b).value * 1e-6,
            falls_through([&](frequency f) { return 1.0 - loop.velocity_sensitivity(f); }, b),
            falls_through([&](frequency f) { return loop.tracking(f); }, b)};
}

} // namespace thesis
