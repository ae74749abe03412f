// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../analysis/frf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace quadrant::diagnosis {

namespace detail {

/// Power of one line of a real signal, from the transform of its even entries as real and its odd ones as
/// imaginary parts.
inline double power_of_line(const std::vector<analysis::complex>& half, std::size_t i) {
    const std::size_t n = half.size();
    const analysis::complex a = half[i % n], b = std::conj(half[(n - i % n) % n]);
    const analysis::complex even = 0.5 * (a + b), odd = analysis::complex(0, -0.5) * (a - b);
    return std::norm(
        even + std::polar(1.0, -std::numbers::pi * static_cast<double>(i) / static_cast<double>(n)) * odd);
}

} // namespace detail

/// Periods at which a signal repeats along z (a position), the strongest first: the signal is gathered in bins
/// of z, a quarter of the shortest period wide, and transformed; `shortest` to `longest`, `count` at most. A
/// bin adds up what falls into it, so that places where the axis dwells weigh more, as in a sum over rows.
inline std::vector<double> spatial_peaks(std::span<const double> signal, std::span<const double> z,
                                         double longest, double shortest, std::size_t count,
                                         std::size_t skip = 0) {
    if (z.size() <= skip || !(longest > shortest)) return {};
    const auto [low, high] = std::minmax_element(z.begin() + static_cast<std::ptrdiff_t>(skip), z.end());
    const double travel = *high - *low;
    if (!(travel > 0)) return {};
    constexpr std::size_t most = std::size_t(1) << 20; // bins: beyond this the shortest period grows
    const double width = std::max(shortest / 4, 1.5 * travel / static_cast<double>(most));
    std::size_t size = 16;
    while (static_cast<double>(size) * width < 1.5 * travel) size *= 2; // lines closer than 1/travel
    // The even bins as real, the odd ones as imaginary parts: half of the transform, and of its memory.
    std::vector<analysis::complex> bins(size / 2);
    for (std::size_t k = skip; k < signal.size(); ++k) {
        const auto bin = static_cast<std::size_t>((z[k] - *low) / width);
        bins[bin / 2] += bin % 2 == 0 ? analysis::complex(signal[k], 0) : analysis::complex(0, signal[k]);
    }
    analysis::fft(bins);
    const double line = 1 / (static_cast<double>(size) * width);
    const auto first = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(1 / (longest * line)))),
               last = std::min(size / 2 - 1, static_cast<std::size_t>(1 / (shortest * line)));
    std::vector<double> powers(last >= first ? last - first + 2 : 0); // from the line before the first on
    for (std::size_t i = 0; i < powers.size(); ++i) powers[i] = detail::power_of_line(bins, first - 1 + i);
    const auto power = [&](std::size_t i) { return powers[i - (first - 1)]; };
    std::vector<std::size_t> peaks;
    for (std::size_t i = first; i < last; ++i)
        if (power(i) > power(i - 1) && power(i) >= power(i + 1)) peaks.push_back(i);
    std::sort(peaks.begin(), peaks.end(), [&](auto a, auto b) { return power(a) > power(b); });
    std::vector<double> out;
    for (auto i : peaks) {
        if (out.size() == count) break;
        const double a = std::sqrt(power(i - 1)), b = std::sqrt(power(i)), c = std::sqrt(power(i + 1));
        const double shift =
            0.5 * (a - c) / (a - 2 * b + c + 1e-300); // the peak of the parabola through three lines
        const double f = (static_cast<double>(i) + std::clamp(shift, -0.5, 0.5)) * line;
        if (std::none_of(out.begin(), out.end(), [&](double p) { return std::abs(1 / p - f) * travel < 1; }))
            out.push_back(1 / f); // not a side lobe of a stronger one
    }
    return out;
}

} // namespace quadrant::diagnosis
