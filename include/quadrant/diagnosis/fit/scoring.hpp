// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// No law is better than some five per cent of the force that it explains.
inline constexpr double law_error = 0.05;

/// Models are distinguished by their residual force while it differs by more than this share of what is left,
/// in energy.
inline constexpr double told_apart = 0.2;

/// Divides scores before they become probabilities: blocks are not independent.
inline constexpr double score_temperature = 5;

/// One view of the innovations: their means over `mean` rows, judged in blocks. The first channel takes every
/// row; each further one averages over longer stretches, in which the noise of the reading, which the observer
/// follows, falls much faster than a force does.
struct channel {
    std::size_t mean = 1, block = 100; ///< rows a mean, rows a block
    double nu = 3;                     ///< effective independent samples of a block
    double floor = 0;                  ///< [m]
    double unknown = 0; ///< part of the floor: the least that a known model leaves here [m]
    /// Mean square below which nothing counts, of each block; empty: that of the floor in all of them.
    std::vector<double> least_of_block{};
    double noise_gain = 1; ///< rms of the means for white noise of the reading with rms 1
    double rounding =
        1; ///< share of a count that matters: while the axis creeps, rounding is a tone, here the worst
    double command_noise = 0; ///< rms of the means for the noise of a measured command [m]
    bool of_tap = false;      ///< of what was measured behind a drive, in the rows behind those of the position
    /// Share of each block's rows in which the axis creeps: by less than two counts a mean, so that rounding
    /// is a tone that the channel sees. Faster, rounding is noise. Empty: in all of them.
    std::vector<double> creeping{};
    std::vector<std::size_t> first_of_block{};   ///< first row of each; blocks leave out what is not judged
    std::vector<std::size_t> segment_of_block{}; ///< motion segment of each

    double least(std::size_t which) const {
        return least_of_block.empty() ? floor * floor : least_of_block[which];
    }
    /// Mean square of what rounding to counts of this size may leave in the means of a block as a tone.
    double of_rounding(double count, std::size_t which) const {
        const double tone = rounding * count / 2;
        return tone * tone * (creeping.empty() ? 1.0 : creeping[which]);
    }
    /// Mean square of what noise leaves in the means: that of the reading, of rms sigma, and of the command.
    double of_noise(double sigma) const {
        return noise_gain * sigma * (noise_gain * sigma) + command_noise * command_noise;
    }
};

/// How innovations become a score. A block of a channel counts nu/2 log(mean square + least): free of scale, so
/// that pulses and quiet stretches, fast and slow forces all count, each against the noise of its own band;
/// bounded below, by the square of the channel's floor or by what the block says. nu is far below the number of
/// rows because innovations are correlated.
struct scoring {
    std::size_t block = 100, skip = 100; ///< rows a block of the first channel, rows not scored at the start
    std::vector<channel> channels{};
    std::size_t segments = 0;

    double floor() const { return channels.empty() ? 0 : channels.front().floor; }
};

namespace detail {

/// Mean squares of the stretches of `block` entries from `first` on.
inline std::vector<double> block_ms(const std::vector<double>& e, std::size_t first, std::size_t block) {
    std::vector<double> out;
    for (std::size_t k = first; k + block <= e.size(); k += block) {
        double sum = 0;
        for (std::size_t i = k; i < k + block; ++i) sum += e[i] * e[i];
        out.push_back(sum / static_cast<double>(block));
    }
    return out;
}
/// Sum of term(i) for i < count; four sums side by side, so that no addition waits for the one before it.
template <class Term> double sum_of(std::size_t count, const Term& term) {
    double a = 0, b = 0, c = 0, d = 0;
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        a += term(i);
        b += term(i + 1);
        c += term(i + 2);
        d += term(i + 3);
    }
    for (; i < count; ++i) a += term(i);
    return (a + b) + (c + d);
}
/// A signal as a channel sees it: the means inside each of its blocks, block after block.
inline std::vector<double> seen(const std::vector<double>& e, const channel& c) {
    std::vector<double> out;
    out.reserve(c.first_of_block.size() * (c.block / c.mean));
    for (const std::size_t first : c.first_of_block)
        for (std::size_t k = first; k + c.mean <= first + c.block; k += c.mean)
            out.push_back(sum_of(c.mean, [row = e.data() + k](std::size_t i) { return row[i]; }) /
                          static_cast<double>(c.mean));
    return out;
}
/// Mean squares of a channel's blocks.
inline std::vector<double> block_ms(const std::vector<double>& e, const channel& c) {
    if (c.mean > 1) return block_ms(seen(e, c), 0, c.block / c.mean);
    std::vector<double> out;
    out.reserve(c.first_of_block.size());
    for (const std::size_t first : c.first_of_block)
        out.push_back(sum_of(c.block, [row = e.data() + first](std::size_t i) { return row[i] * row[i]; }) /
                      static_cast<double>(c.block));
    return out;
}

/// What means over c.mean rows see of the reading's noise behind an observer with both poles at `pole`: the
/// noise passes (1 - 1/z)^2 / (1 - pole/z)^2.
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

/// The channels of a record: every row, a fifth of a block, then five times longer each, as long as there are
/// `least` blocks. `segment`: of every row; lay(block): the first rows of the blocks of this length.
template <class Lay>
std::vector<channel> channels_of(std::size_t mean, double resolution, double pole,
                                 const std::vector<std::size_t>& segment, Lay lay) {
    constexpr std::size_t least = 5;
    std::vector<channel> out;
    const auto add = [&](std::size_t rows, std::size_t block) {
        channel c{.mean = rows, .block = block, .first_of_block = lay(block)};
        if (out.size() > 1 && c.first_of_block.size() < least) return false;
        for (const std::size_t first : c.first_of_block)
            c.segment_of_block.push_back(segment[first + block / 2]);
        set_gains(c, pole);
        if (rows <= mean) c.rounding = 1; // a pulse below half a count moves nothing that anybody reads
        c.floor = (rows == 1 ? 0.4 : 0.2) * resolution * c.rounding;
        out.push_back(std::move(c));
        return true;
    };
    add(1, 5 * mean);
    add(mean, 5 * mean);
    for (std::size_t rows = 5 * mean; add(rows, 5 * rows);) rows *= 5;
    return out;
}

/// The channels of a record and the same again for the rows behind it, in which a signal with white noise of
/// the same size stands that no observer follows. Where the axis rests, the rounding of its reading stays as it
/// is, and no mean over rows is better than the floor; where it moves, the means are as good as their number.
inline std::vector<channel> and_tap(std::vector<channel> channels, std::size_t rows, double resolution) {
    const std::size_t own = channels.size();
    for (std::size_t i = 0; i < own; ++i) {
        channel c = channels[i];
        c.of_tap = true;
        for (std::size_t& first : c.first_of_block) first += rows;
        c.floor /= c.rounding;
        c.rounding = 1;
        c.noise_gain = 1 / std::sqrt(static_cast<double>(c.mean));
        if (c.mean > 1)
            for (double rests : c.creeping)
                c.least_of_block.push_back(rests * c.floor * c.floor +
                                           resolution * resolution / (12 * static_cast<double>(c.mean)));
        channels.push_back(std::move(c));
    }
    return channels;
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
