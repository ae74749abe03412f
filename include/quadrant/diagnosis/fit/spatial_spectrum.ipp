// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../analysis/frf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadrant::inline v0::diagnosis {

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

/// The periods of the highest peaks of a spectrum, of which `powers` are the lines from `first` on.
inline std::vector<double> highest_peaks(std::span<const double> powers, std::size_t first, double line,
                                         double travel, std::size_t count) {
    std::vector<std::size_t> peaks;
    for (std::size_t i = 1; i + 1 < powers.size(); ++i)
        if (powers[i] > powers[i - 1] && powers[i] >= powers[i + 1]) peaks.push_back(i);
    std::sort(peaks.begin(), peaks.end(), [&](auto a, auto b) { return powers[a] > powers[b]; });
    std::vector<double> out;
    for (auto i : peaks) {
        if (out.size() == count) break;
        const double a = std::sqrt(powers[i - 1]), b = std::sqrt(powers[i]), c = std::sqrt(powers[i + 1]);
        const double shift =
            0.5 * (a - c) / (a - 2 * b + c + 1e-300); // the peak of the parabola through three lines
        const double f = (static_cast<double>(first + i) + std::clamp(shift, -0.5, 0.5)) * line;
        if (std::none_of(out.begin(), out.end(), [&](double p) { return std::abs(1 / p - f) * travel < 1; }))
            out.push_back(1 / f); // not a side lobe of a stronger one
    }
    return out;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::vector<double> spatial_peaks(std::span<const double> signal,
                                                          std::span<const double> z, double longest,
                                                          double shortest, std::size_t count,
                                                          std::size_t skip) {
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
    return detail::highest_peaks(powers, first - 1, line, travel, count);
}

QUADRANT_DIAGNOSIS_DECL std::vector<double>
carried_peaks(std::span<const double> signal, std::span<const double> carrier, std::span<const double> z,
              double longest, double shortest, std::size_t count, std::size_t skip) {
    if (z.size() <= skip || !(longest > shortest)) return {};
    const auto [low, high] = std::minmax_element(z.begin() + static_cast<std::ptrdiff_t>(skip), z.end());
    const double travel = *high - *low;
    if (!(travel > 0)) return {};
    constexpr std::size_t most = std::size_t(1) << 18;
    const double width = std::max(shortest / 8, 4 * travel / static_cast<double>(most));
    std::size_t size = 16;
    while (static_cast<double>(size) * width < 3 * travel) size *= 2; // half a line is half a turn at the ends
    std::vector<analysis::complex> with(size), squares(size);
    double weight = 0, level = 0;
    for (std::size_t k = skip; k < signal.size(); ++k) {
        const auto bin = static_cast<std::size_t>((z[k] - *low) / width);
        with[bin] += signal[k] * carrier[k];
        squares[bin] += carrier[k] * carrier[k];
        weight += carrier[k] * carrier[k];
        level += signal[k] * carrier[k];
    }
    if (!(weight > 0)) return {};
    analysis::fft(with);
    analysis::fft(squares);
    const double line = 1 / (static_cast<double>(size) * width), ridge = 0.01 * weight;
    const auto first = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(1 / (longest * line)))),
               last = std::min(size / 4, static_cast<std::size_t>(1 / (shortest * line)));
    std::vector<double> taken(last >= first ? last - first + 1 : 0);
    for (std::size_t i = first; i <= last; ++i) {
        const analysis::complex one = squares[i], two = squares[2 * i], b = with[i] - one * (level / weight);
        const double cc = (weight + two.real()) / 2 - one.real() * one.real() / weight + ridge;
        const double ss = (weight - two.real()) / 2 - one.imag() * one.imag() / weight + ridge;
        const double cs = two.imag() / 2 - one.real() * one.imag() / weight;
        taken[i - first] =
            (ss * b.real() * b.real() - 2 * cs * b.real() * b.imag() + cc * b.imag() * b.imag()) /
            (cc * ss - cs * cs);
    }
    return detail::highest_peaks(taken, first, line, travel, count);
}

} // namespace quadrant::inline v0::diagnosis
