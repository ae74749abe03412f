// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

struct sample_clock {
    double period = 0;
    double jitter = 0; ///< half the range of the stamps about their instants k T, in periods
};

/// Period of the stamps t[k] = t0 + k T + jitter. `refuse(row, message)` throws.
template <class Refuse> sample_clock read_even_clock(const std::vector<double>& t, Refuse refuse) {
    constexpr double allowed = 0.2; // docs/formats.md
    constexpr double leeway = 0.01; // the line through the stamps is itself an estimate
    const std::size_t n = t.size();
    std::vector<double> steps(n - 1);
    for (std::size_t k = 1; k < n; ++k) {
        steps[k - 1] = t[k] - t[k - 1];
        if (!(steps[k - 1] > 0)) refuse(k, fmt::format("t_s: {} does not come after {}", t[k], t[k - 1]));
    }

    // The median step survives lost rows; the mean of the steps like it survives stamps written too coarsely.
    auto sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double median = *middle;
    double sum = 0, count = 0;
    for (double step : steps)
        if (std::abs(step / median - 1) <= 0.6) {
            sum += step;
            ++count;
        }
    const double usual = sum / count;
    // Jitter makes steps of 0.6 T to 1.4 T, a lost row at least 1.6 T.
    for (std::size_t k = 1; k < n; ++k)
        if (steps[k - 1] > 1.5 * usual)
            refuse(k,
                   fmt::format(
                       "rows missing before this one: {:.0f} (the stamps advance by {:.6g} s here, by {:.6g} s "
                       "elsewhere)",
                       std::max(1.0, std::round(steps[k - 1] / usual) - 1), steps[k - 1], usual));

    // Least squares about the plain mean, on which the jitter of the two ends would weigh.
    const auto count_of_steps = static_cast<double>(n - 1);
    const double plain = (t[n - 1] - t[0]) / count_of_steps;
    const auto from_middle = [&](std::size_t k) { return static_cast<double>(k) - 0.5 * count_of_steps; };
    const auto off_plain = [&](std::size_t k) { return t[k] - t[0] - plain * static_cast<double>(k); };
    double product = 0, square = 0;
    for (std::size_t k = 0; k < n; ++k) {
        product += from_middle(k) * off_plain(k);
        square += from_middle(k) * from_middle(k);
    }
    const double correction = product / square;
    const auto off_line = [&](std::size_t k) { return off_plain(k) - correction * from_middle(k); };
    std::size_t latest = 0, earliest = 0;
    for (std::size_t k = 1; k < n; ++k) {
        if (off_line(k) > off_line(latest)) latest = k;
        if (off_line(k) < off_line(earliest)) earliest = k;
    }
    const double period = plain + correction;
    const sample_clock out{period, 0.5 * (off_line(latest) - off_line(earliest)) / period};
    if (out.jitter <= allowed + leeway) return out;
    double mean = 0;
    for (std::size_t k = 0; k < n; ++k) mean += off_line(k) / static_cast<double>(n);
    refuse(
        off_line(latest) - mean > mean - off_line(earliest) ? latest : earliest,
        fmt::format(
            "t_s: the stamps jitter by {:.2g} of the period of {:.4g} s, most of all here; up to {} is allowed",
            out.jitter, period, allowed));
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
