// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrant::diagnosis {

/// One view of the innovations: their means over `mean` rows, judged in blocks. The first channel takes every row; each
/// further one averages over longer stretches, in which the noise of the reading, which the observer follows, falls much
/// faster than a force does.
struct channel {
    std::size_t mean = 1, block = 100; ///< rows a mean, rows a block
    double nu = 3;                     ///< effective independent samples of a block
    double floor = 0;                  ///< [m]
    double noise_gain = 1;             ///< rms of the means for white noise of the reading with rms 1
    double rounding =
        1; ///< share of a count that matters: while the axis creeps, rounding is a tone, here the worst
    std::vector<std::size_t> first_of_block{};   ///< first row of each block
    std::vector<std::size_t> segment_of_block{}; ///< motion segment each block belongs to
};

/// How innovations become a score. A block of a channel counts nu/2 log(mean square + floor^2): free of scale, so that
/// pulses and quiet stretches, fast and slow forces all count, each against the noise of its own band; bounded below by
/// the floor. nu is far below the number of rows because innovations are correlated.
struct scoring {
    std::size_t block = 100, skip = 100; ///< rows a block of the first channel, rows not scored at the start
    std::vector<channel> channels{};
    std::size_t segments = 0;

    double floor() const { return channels.empty() ? 0 : channels.front().floor; }
};

namespace detail {

inline std::vector<double> block_ms(const std::vector<double>& e, std::size_t first, std::size_t block) {
    std::vector<double> out;
    for (std::size_t k = first; k + block <= e.size(); k += block) {
        double sum = 0;
        for (std::size_t i = k; i < k + block; ++i) sum += e[i] * e[i];
        out.push_back(sum / static_cast<double>(block));
    }
    return out;
}
/// The means that a channel sees, block after block; rows between its blocks are not judged.
inline std::vector<double> means(const std::vector<double>& e, const channel& c) {
    std::vector<double> out;
    out.reserve(c.first_of_block.size() * (c.block / c.mean));
    for (const std::size_t first : c.first_of_block)
        for (std::size_t k = first; k + c.mean <= first + c.block; k += c.mean) {
            double sum = 0;
            for (std::size_t i = k; i < k + c.mean; ++i) sum += e[i];
            out.push_back(sum / static_cast<double>(c.mean));
        }
    return out;
}

/// First rows of blocks that follow one another from `skip` on, around the rows that are not judged (of every row: 1; empty:
/// all are).
inline std::vector<std::size_t> block_starts(std::size_t rows, std::size_t skip, std::size_t block,
                                             const std::vector<unsigned char>& not_judged) {
    std::vector<std::size_t> out;
    for (std::size_t first = skip; first + block <= rows;) {
        std::size_t end = not_judged.empty() ? first : first + block;
        while (end > first && !not_judged[end - 1]) --end;
        if (end == first) out.push_back(first);
        first = end > first ? end : first + block; // behind the last row of it that is not judged
    }
    return out;
}

/// What means over c.mean rows see of the reading's noise behind an observer with both poles at `pole`: the noise
/// passes (1 - 1/z)^2 / (1 - pole/z)^2.
inline void set_gains(channel& c, double pole) {
    const std::size_t points = 16 * c.mean + 4096;
    double sum = 0, worst = 0;
    for (std::size_t i = 0; i < points; ++i) {
        const double w = std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(points);
        const auto m = static_cast<double>(c.mean);
        const double follows =
            std::norm(1.0 - std::polar(1.0, -w)) / std::norm(1.0 - pole * std::polar(1.0, -w));
        const double gain = follows * std::abs(std::sin(m * w / 2) / (m * std::sin(w / 2)));
        sum += gain * gain / static_cast<double>(points);
        worst = std::max(worst, gain);
    }
    c.noise_gain = std::sqrt(sum);
    c.rounding = worst;
}

/// The channels of a record: every row, a fifth of a block, then five times longer each, as long as there are `least`
/// blocks. `segment`, and `not_judged` as in block_starts(): of every row.
inline std::vector<channel> channels_of(std::size_t mean, std::size_t skip, double resolution, double pole,
                                        const std::vector<std::size_t>& segment,
                                        const std::vector<unsigned char>& not_judged) {
    constexpr std::size_t least = 5;
    std::vector<channel> out;
    const auto add = [&](std::size_t rows, std::size_t block) {
        channel c{.mean = rows, .block = block};
        set_gains(c, pole);
        if (rows <= mean) c.rounding = 1; // a pulse below half a count moves nothing that anybody reads
        c.floor = (rows == 1 ? 0.4 : 0.2) * resolution * c.rounding;
        c.first_of_block = block_starts(segment.size(), skip, block, not_judged);
        for (const std::size_t first : c.first_of_block)
            c.segment_of_block.push_back(segment[first + block / 2]);
        if (out.size() > 1 && c.segment_of_block.size() < least) return false;
        out.push_back(std::move(c));
        return true;
    };
    add(1, 5 * mean);
    add(mean, 5 * mean);
    for (std::size_t rows = 5 * mean; add(rows, 5 * rows);) rows *= 5;
    return out;
}

} // namespace detail

} // namespace quadrant::diagnosis
