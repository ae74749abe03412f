// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::diagnosis::detail {
/// Power of a signal at a frequency and its next three multiples below 200 Hz.
inline double comb_power(const std::vector<double>& signal, double period, double fundamental_period) {
    double sum = 0;
    for (int i = 1; i <= 4; ++i) {
        const double step = 2 * std::numbers::pi * i * period / fundamental_period;
        if (i / fundamental_period > 200) break;
        std::complex<double> total, phasor = 1;
        const auto turn = std::polar(1.0, step);
        for (double x : signal) {
            total += x * phasor;
            phasor *= turn;
        }
        sum += std::norm(total);
    }
    return sum;
}
inline harmonics& cutting_force_harmonics(plant_model& p) { return p.cutting; }
} // namespace quadrant::diagnosis::detail

namespace quadrant::diagnosis::suspect {

/// Force periodic in time: mean + sum of N_i sin(2 pi i f t + phase_i), a turning cutter or spindle. Joins the force. Shows as
/// lines in the frequency of the residual that no motion shifts. The mean cannot be told from a constant force; the phase
/// begins anew with each log. The fundamental up to 200 Hz: above, rounding of the encoder makes limit cycles.
inline constexpr effect cutting_force{
    .name = "cutting_force",
    .box = "process",
    .exciting_motion = "rest and slow strokes with the process running, and again with it off",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double duration = detail::duration(s), most = 10 * s.leader.force_constant;
        std::vector<double> time(s.residual.size());
        for (std::size_t k = 0; k < time.size(); ++k) time[k] = static_cast<double>(k) * s.record.period;
        const double shortest = std::max(1.0 / 200, 10 * s.record.period), longest = 0.5;
        const auto peaks = spatial_peaks(s.residual, time, longest, shortest, 4, s.record.score.skip);
        std::vector<double>
            periods; // any peak may be any harmonic: the comb that gathers most, and the next best
        for (double peak : peaks)
            for (double order : {1.0, 2.0, 3.0, 4.0})
                if (order * peak <= longest) periods.push_back(order * peak);
        std::vector<double> power(periods.size());
        for (std::size_t i = 0; i < periods.size(); ++i)
            power[i] = detail::comb_power(s.residual, s.record.period, periods[i]);
        for (std::size_t i = periods.size(); i-- > 1;) // the same line by two ways
            for (std::size_t j = 0; j < i; ++j)
                if (std::abs(periods[i] / periods[j] - 1) < periods[j] / duration) power[i] = -1;
        while (periods.size() > 2) {
            const auto least = std::min_element(power.begin(), power.end()) - power.begin();
            periods.erase(periods.begin() + least);
            power.erase(power.begin() + least);
        }
        std::vector<std::vector<parameter>> out;
        for (double period : periods) {
            out.push_back(detail::repeating<detail::cutting_force_harmonics, 4>(
                "process.fundamental_Hz", "process.force_N", period, duration, most));
            out.back().push_back({.key = "process.mean_N",
                                  .of = [](plant_model& p) -> double& { return p.cutting_mean; },
                                  .start = 0,
                                  .low = -most,
                                  .high = most,
                                  .step = 1e-5 * s.leader.force_constant});
        }
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"process.fundamental_Hz", {1 / p.cutting.period}},
                {"process.force_N", p.cutting.sizes()},
                {"process.phase_rad", p.cutting.phases()},
                {"process.mean_N", {p.cutting_mean}}};
    },
    .join = [](plant_model& p) { p.cutting.count = 4; }};

} // namespace quadrant::diagnosis::suspect
