// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "fit_circles.hpp"

#include <complex>

/// What is periodic along an axis (a cyclic error) or in time (a vibration), sought in what the other errors
/// leave.
namespace quadrant::inline v0::diagnosis::detail {

/// Sample by sample of every run.
using residuals = std::vector<std::vector<double>>;

/// A sum of squares of noise with so many degrees of freedom stays below this many times its mean in all of
/// `places` places, but for one record in a thousand [Laurent2000].
inline double noise_peak(double freedom, double places) {
    const double l = std::log(1000 * places);
    return 1 + 2 * std::sqrt(l / freedom) + 2 * l / freedom;
}
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Mean power of noise around place k of a spectrum, from the larger of both sides' medians: what is smooth
/// there is no peak. Without enough neighbours infinite.
inline double around(const std::vector<double>& power, std::size_t k, std::size_t next, std::size_t many) {
    if (k < next + many / 2 || k + next + many / 2 >= power.size()) return HUGE_VAL;
    const auto at = [&](std::size_t i) { return power.begin() + static_cast<std::ptrdiff_t>(i); };
    const double below = median({at(k - std::min(k, next + many)), at(k - next)}),
                 above = median({at(k + next + 1), at(std::min(power.size(), k + next + many + 1))});
    return std::max({below, above, 1e-300});
}

struct periodic_error {
    bool there = false;
    int axis = 0;                         ///< 0: x, 1: y
    double period = 0;                    ///< along the axis [m], or the frequency [Hz]
    double energy = 0;                    ///< what it takes out of the sum of squares
    double threshold = 0;                 ///< amplitude that would have been found
    std::vector<double> amplitude, error; ///< one a run, with its standard error
    std::vector<double> phase;
    double common = 1; ///< share of the energy that one amplitude and phase for all runs explains
};

} // namespace quadrant::inline v0::diagnosis::detail
