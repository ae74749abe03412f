// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace quadrant::inline v0::analysis {

/// A position or a displacement along an axis.
using displacement = quantity_of<signal::position>;

/// A number with its interval of 95 %.
template <class Quantity> struct estimated {
    Quantity value, low, high;
    bool holds(Quantity truth) const { return low <= truth && truth <= high; }
};

/// How many standard errors an interval of 95 % reaches to either side when the standard error itself comes
/// from so many
/// degrees of freedom: Student's t at 0.975, by its expansion about the normal one from 3 on (within 1 %).
inline double student_95(double freedom) {
    require(freedom >= 1, "student_95.freedom", freedom, "must be 1 or more");
    if (freedom < 1.5) return 12.706;
    if (freedom < 2.5) return 4.303;
    const double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, n = freedom;
    return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
           (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

/// The steady part of a record and its mean.
struct steady_mean {
    double mean, standard_error;
    double freedom;    ///< of standard_error
    std::size_t first; ///< value from which on it is steady
    bool settled;      ///< the run in was over within three quarters of the record
};

/// Mean of what a record settles to. The run in ends where the rest gives the mean with the smallest spread,
/// the MSER rule of [White1997]. Neighbouring values may be correlated: the standard error is that of 16 means
/// of consecutive values, widened by what correlation is left between those.
inline steady_mean settle_mean(const std::vector<double>& x) {
    constexpr std::size_t parts = 16;
    require(x.size() >= 4 * parts, "settle_mean.values", double(x.size()), "must be 64 or more");
    const std::size_t n = x.size(), latest = n - n / 4;
    std::size_t first = 0;
    double sum = 0, squares = 0, best = HUGE_VAL;
    for (std::size_t i = n; i-- > 0;) {
        const double off = x[i] - x.back(), count = double(n - i); // about the last: no cancellation
        sum += off, squares += off * off;
        const double spread = (squares - sum * sum / count) / (count * count);
        if (i <= latest && spread <= best) best = spread, first = i;
    }
    const std::size_t width = (n - first) / parts, from = n - parts * width;
    std::vector<double> means(parts);
    double mean = 0;
    for (std::size_t p = 0; p < parts; ++p) {
        for (std::size_t i = 0; i < width; ++i) means[p] += x[from + p * width + i] / double(width);
        mean += means[p] / double(parts);
    }
    double variance = 0, next = 0;
    for (std::size_t p = 0; p < parts; ++p) {
        variance += (means[p] - mean) * (means[p] - mean) / double(parts - 1);
        if (p > 0) next += (means[p] - mean) * (means[p - 1] - mean) / double(parts - 1);
    }
    const double correlation = variance > 0 ? std::clamp(next / variance, 0.0, 0.8) : 0;
    return {mean, std::sqrt(variance / double(parts) * (1 + correlation) / (1 - correlation)),
            double(parts - 1), first, first < latest};
}

} // namespace quadrant::inline v0::analysis
