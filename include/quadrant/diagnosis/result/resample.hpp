// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/signals.hpp"
#include "result.hpp"

#include <cstdint>
#include <random>

namespace quadrant::inline v0::diagnosis {

/// Draws whole motion segments with replacement, the same draws for the same number of segments: how many times
/// each segment counts in each draw. Samples inside a segment are correlated; segments are what is independent.
inline std::vector<std::vector<double>> segment_draws(std::size_t segments, std::size_t draws = 400) {
    std::mt19937_64 random(20080901);
    std::vector<std::vector<double>> out(draws, std::vector<double>(segments, 0.0));
    for (auto& draw : out)
        for (std::size_t i = 0; i < segments; ++i)
            draw[random() % segments] += 1; // not uniform_int: same on every library
    return out;
}

/// A statistic of per-segment sums with its 95 % interval over the draws.
template <class Statistic>
estimate resampled(const std::vector<std::vector<double>>& draws, std::size_t segments, Statistic statistic) {
    estimate out;
    out.value = statistic(std::vector<double>(segments, 1.0));
    std::vector<double> values;
    values.reserve(draws.size());
    for (const auto& draw : draws) values.push_back(statistic(draw));
    out.low = std::min(out.value, quantile(values, 0.025));
    out.high = std::max(out.value, quantile(values, 0.975));
    return out;
}

/// Per-segment sums of squares, and how many rows each has.
struct segment_energy {
    std::vector<double> sum, rows;
    segment_energy(std::span<const double> x, std::span<const std::size_t> segment, std::size_t segments,
                   std::size_t skip = 0)
        : sum(segments, 0.0), rows(segments, 0.0) {
        for (std::size_t k = skip; k < x.size(); ++k) {
            sum[segment[k]] += x[k] * x[k];
            rows[segment[k]] += 1;
        }
    }
    double rms(const std::vector<double>& weight) const {
        double s = 0, n = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            s += weight[i] * sum[i];
            n += weight[i] * rows[i];
        }
        return n > 0 ? std::sqrt(s / n) : 0;
    }
};

} // namespace quadrant::inline v0::diagnosis
