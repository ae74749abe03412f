// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/base/literals.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

inline const duration T = 500_us;

struct random_numbers {
    std::mt19937 engine{42};
    double between(double low, double high) { return std::uniform_real_distribution(low, high)(engine); }
    double decades(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    /// Offset, sine and noise of any shares and sizes.
    std::vector<double> signal(std::size_t samples) {
        const double size = decades(1e-3, 1e3), offset = between(-1, 1), w = decades(1e-3, 3),
                     noise = decades(1e-4, 1);
        std::vector<double> x(samples);
        for (std::size_t k = 0; k < samples; ++k)
            x[k] = size * (offset + std::sin(w * double(k)) + noise * between(-1, 1));
        return x;
    }
};
/// How much of its bound a jump took; `rounding` relative to what was added up.
struct verdict {
    double most = 0;
    int broken = 0;
    void operator()(double jump, double bound, double rounding) {
        broken += !(std::abs(jump) <= bound + rounding);
        if (bound > 1e3 * rounding) most = std::max(most, std::abs(jump) / bound);
    }
};
inline double largest(const std::vector<double>& x) {
    double most = 0;
    for (const double each : x) most = std::max(most, std::abs(each));
    return most;
}
template <class Block> double step(Block& block, double x) {
    return block(Block::argument::from_value(x)).value();
}
template <class Block> double first(Block fresh) { return step(fresh, 1); } ///< of an impulse: b0
