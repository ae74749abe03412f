// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../filter/notch.hpp"
#include "frf.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Where to look for a peak, and what is wanted of its notch.
struct notch_rule {
    frequency above;              ///< peaks below are the base's, not to be notched
    frequency crossover;          ///< of the velocity loop, |L_v| = 1
    double attenuation_db = 20;   ///< over the peak's half-power width and `drift`; > 0
    double drift = 0.02;          ///< the peak may move by this part of its frequency, either way; 0 ... 0.5
    double prominence_db = 3;     ///< what stands out less is no peak
    double most_phase = 20;       ///< degrees that the notch may cost at the crossover
    double least_coherence = 0.5; ///< lines below are left out
};

/// A notch for one peak, what it attenuates, and what it costs in phase.
template <signal_tag Signal> struct notch_design {
    typename notch<Signal>::parameters parameters;
    frequency low, high;  ///< attenuated by what was asked for, or more
    double prominence_db; ///< of the peak in the velocity response
    double damping;       ///< ratio of the mode, from the peak's half-power width
    double phase_cost;    ///< degrees at the crossover
};

namespace detail {

struct velocity_peak {
    frequency at, low, high; ///< low, high: half power
    double prominence;       ///< ratio
};
/// The largest local maximum of size[] that stands out: over both passes between it and something higher (or
/// the ends).
inline std::optional<velocity_peak> largest_peak(const std::vector<double>& f, const std::vector<double>& size,
                                                 double above, double prominence) {
    std::optional<velocity_peak> out;
    double largest = 0;
    for (std::size_t i = 1; i + 1 < size.size(); ++i) {
        if (f[i] <= above || size[i] <= size[i - 1] || size[i] < size[i + 1] || size[i] <= largest) continue;
        double left = size[i], right = size[i];
        for (std::size_t k = i; k-- > 0 && size[k] <= size[i];) left = std::min(left, size[k]);
        for (std::size_t k = i + 1; k < size.size() && size[k] <= size[i]; ++k)
            right = std::min(right, size[k]);
        const double stands = size[i] / std::max(left, right);
        if (stands < prominence) continue;
        largest = size[i];
        // Top of the parabola through three lines of ln size; half power between lines of size.
        const double a = std::log(size[i - 1]), b = std::log(size[i]), c = std::log(size[i + 1]);
        const double curve = a - 2 * b + c,
                     shift = curve < 0 ? std::clamp(0.5 * (a - c) / curve, -0.5, 0.5) : 0;
        const double top = std::exp(b - 0.25 * (a - c) * shift), half = top / std::numbers::sqrt2;
        const double centre = f[i] + shift * (shift > 0 ? f[i + 1] - f[i] : f[i] - f[i - 1]);
        const auto cross = [&](std::size_t inside, std::size_t outside) {
            return f[outside] +
                   (f[inside] - f[outside]) * (half - size[outside]) / (size[inside] - size[outside]);
        };
        double low = f.front(), high = f.back();
        for (std::size_t k = i; k-- > 0;)
            if (size[k] < half) {
                low = cross(k + 1, k);
                break;
            }
        for (std::size_t k = i + 1; k < size.size(); ++k)
            if (size[k] < half) {
                high = cross(k - 1, k);
                break;
            }
        out = {hertz(centre), hertz(low), hertz(high), stands};
    }
    return out;
}
} // namespace detail

/// A notch for the highest structural peak of an axis above a frequency: highest in the velocity response f
/// |G|, since that is what lifts the velocity loop. Centre at the peak's top; damping such that both ends of
/// its half-power width, and
/// of its drift, are attenuated as asked:
///   |N| = |1 - r^2|/sqrt((1 - r^2)^2 + (damping r)^2),  r = f/centre   (bilinear, pre-warped at the centre)
/// The half-power width is the mode's (and its damping) where the peak stands out by 10 dB or more; less, and
/// it is wider. Throws "design_notch.<what> = ...": no peak; centre plus half the notch's width not below half
/// the sampling rate; centre minus it not above the crossover, in the band of the loop; more phase at the
/// crossover than allowed.
template <signal_tag Signal>
notch_design<Signal> design_notch(const measured_frf& frf, duration period, const notch_rule& rule) {
    require_positive("design_notch.period", period);
    require_positive("design_notch.above", rule.above);
    require_positive("design_notch.crossover", rule.crossover);
    require_positive("design_notch.attenuation_db", rule.attenuation_db);
    require(rule.drift >= 0 && rule.drift <= 0.5, "design_notch.drift", rule.drift,
            "must lie between 0 and 0.5");
    require_positive("design_notch.prominence_db", rule.prominence_db);
    require_positive("design_notch.most_phase", rule.most_phase);
    std::vector<double> f, size;
    for (const auto& line : frf.lines)
        if (line.coherence >= rule.least_coherence && std::abs(line.value) > 0)
            f.push_back(line.f.value()), size.push_back(line.f.value() * std::abs(line.value));
    const auto peak =
        detail::largest_peak(f, size, rule.above.value(), std::pow(10.0, rule.prominence_db / 20));
    require(peak.has_value(), "design_notch.above", rule.above,
            "no peak above it stands out by " + quadrant::detail::shortest(rule.prominence_db) + " dB");
    const frequency low = std::min(peak->low, (1 - rule.drift) * peak->at),
                    high = std::max(peak->high, (1 + rule.drift) * peak->at);
    const double nyquist = 0.5 / period.value();
    require(high.value() < nyquist, "design_notch: upper end of the peak", high,
            "must lie below half the sampling rate (" +
                quadrant::detail::shortest(quadrant::detail::in_unit(nyquist, " Hz")) + ")");
    const auto warped = [&](frequency at) { return std::tan(std::numbers::pi * at.value() * period.value()); };
    const double gain = std::pow(10.0, -rule.attenuation_db / 20);
    double width = 0;
    for (const frequency& end : {low, high}) {
        const double r = warped(end) / warped(peak->at);
        width = std::max(width, std::abs(1 - r * r) / r * std::sqrt(1 / (gain * gain) - 1));
    }
    const double half_width = 0.5 * width * peak->at.value();
    require(peak->at.value() + half_width < nyquist, "design_notch: centre plus half its width",
            quadrant::detail::in_unit(peak->at.value() + half_width, " Hz"),
            "must lie below half the sampling rate (" +
                quadrant::detail::shortest(quadrant::detail::in_unit(nyquist, " Hz")) +
                "): ask for less attenuation or drift");
    require(peak->at.value() - half_width > rule.crossover.value(), "design_notch: centre minus half its width",
            quadrant::detail::in_unit(peak->at.value() - half_width, " Hz"),
            "must lie above the crossover (" + quadrant::detail::shortest(rule.crossover) +
                "): the peak lies in the band of the loop; lower the gain instead");
    const typename notch<Signal>::parameters parameters{peak->at, width};
    const double phase =
        -std::arg(notch<Signal>(parameters, period).response(rule.crossover)) * 180 / std::numbers::pi;
    require(phase <= rule.most_phase, "design_notch: phase at the crossover",
            quadrant::detail::in_unit(phase, " degrees"),
            "must not be above " + quadrant::detail::shortest(rule.most_phase) +
                " degrees: ask for less attenuation or drift");
    return {
        parameters, low, high, decibel(peak->prominence), 0.5 * ((peak->high - peak->low) / peak->at).value(),
        phase};
}

} // namespace quadrant::inline v0::analysis
