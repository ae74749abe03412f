// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "periodic.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Jumps back and forth of one axis within 25 degrees after its reversals, of what is quicker than 6 degrees in
/// what the other errors leave. A jump counts when it is eight times the
/// usual size of what is left more than 35 degrees from the reversals.
struct stick_slip_found {
    double swings = 0;            ///< a reversal, median
    double height = 0, error = 0; ///< of a swing, and its standard error
    double threshold = 0;
};

inline stick_slip_found stick_slip_of(const circle_run& r, const std::vector<double>& left, int axis) {
    constexpr double degree = std::numbers::pi / 180;
    const auto n = left.size();
    const double step = std::abs(r.angle.back() - r.angle.front()) / double(n - 1);
    std::vector<double> sums(n + 1);
    for (std::size_t k = 0; k < n; ++k) sums[k + 1] = sums[k] + left[k];
    const auto mean = [&](std::size_t k, double width) {
        const auto half = std::max<std::size_t>(1, static_cast<std::size_t>(0.5 * width / step));
        const std::size_t from = k > half ? k - half : 0, to = std::min(n, k + half + 1);
        return (sums[to] - sums[from]) / double(to - from);
    };
    std::vector<double> quick(n);
    std::vector<double> elsewhere;
    for (std::size_t k = 0; k < n; ++k) {
        quick[k] = mean(k, 0.2 * degree) - mean(k, 6 * degree);
        if (from_reversal(r.angle[k]) > 35 * degree) elsewhere.push_back(std::abs(quick[k]));
    }
    stick_slip_found out;
    if (elsewhere.empty()) return out;
    out.threshold = 8 * median(elsewhere) / 0.67;
    std::vector<double> swings, heights;
    const auto close = [&](double number) { swings.push_back(number); };
    double number = 0, low = 0, high = 0, last = HUGE_VAL;
    bool inside = false, up = true;
    for (std::size_t k = 0; k < n; ++k) {
        const double since = reversed({r.angle[k], r.feed, r.radius, r.turning()}, axis).angle;
        if (inside && (since > 25 * degree || since < last)) close(number), inside = false;
        last = since;
        if (since > 25 * degree) continue;
        if (!inside) inside = true, number = 0, low = high = quick[k], up = true;
        low = std::min(low, quick[k]), high = std::max(high, quick[k]);
        if (up ? high - quick[k] > out.threshold : quick[k] - low > out.threshold) { // turned round
            heights.push_back(high - low), ++number, up = !up;
            low = high = quick[k];
        }
    }
    if (swings.empty()) return out;
    out.swings = median(swings);
    if (heights.size() < 4) return out;
    out.height = median(heights);
    double spread = 0;
    for (const double h : heights) spread += std::pow(h - out.height, 2) / double(heights.size());
    out.error = std::sqrt(spread / double(heights.size()));
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
