// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstddef>
#include <vector>

namespace quadrant::diagnosis {

/// How innovations become a score. Two channels: the innovation itself, and its mean over a fifth of a block, which is
/// blind to the encoder's rounding and sees slow forces. A block counts nu/2 log(mean square + floor^2):
/// free of scale, so that pulses and quiet stretches both count, and bounded below by the floor. nu is the effective
/// number of independent samples of a block, far below the number of rows because innovations are correlated.
struct scoring {
    std::size_t block = 100, mean = 20, skip = 100; ///< rows a block, rows a mean, rows not scored at the start
    double floor = 0, floor_mean = 0;               ///< [m]
    double nu = 3, nu_mean = 3;
    std::vector<std::size_t> first_of_block;   ///< first row of each block; blocks leave out what is not judged
    std::vector<std::size_t> segment_of_block; ///< motion segment each block belongs to
    std::size_t segments = 0;
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
/// The same over the blocks of a score.
inline std::vector<double> block_ms(const std::vector<double>& e, const scoring& s) {
    std::vector<double> out;
    out.reserve(s.first_of_block.size());
    for (const std::size_t first : s.first_of_block) {
        double sum = 0;
        for (std::size_t i = first; i < first + s.block; ++i) sum += e[i] * e[i];
        out.push_back(sum / static_cast<double>(s.block));
    }
    return out;
}
/// The means inside each block, block after block.
inline std::vector<double> means(const std::vector<double>& e, const scoring& s) {
    std::vector<double> out;
    out.reserve(s.first_of_block.size() * (s.block / s.mean));
    for (const std::size_t first : s.first_of_block)
        for (std::size_t k = first; k + s.mean <= first + s.block; k += s.mean) {
            double sum = 0;
            for (std::size_t i = k; i < k + s.mean; ++i) sum += e[i];
            out.push_back(sum / static_cast<double>(s.mean));
        }
    return out;
}

} // namespace detail

} // namespace quadrant::diagnosis
