// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../model/driven_motion.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// The rows whose set-points a drive takes, one after another.
inline std::vector<std::size_t> arrivals(const drive_model& d, std::span<const double> set_points,
                                         double period, std::span<const log_start> others) {
    std::vector<std::size_t> out;
    std::size_t first = 0;
    for (std::size_t log = 0; log <= others.size(); ++log) {
        const std::size_t end = log < others.size() ? others[log].row : set_points.size();
        const set_point_arrivals clock(d, period, set_points.subspan(first, end - first));
        for (long n = 0; first + clock.row(n) < end; ++n)
            if (const std::size_t row = first + clock.row(n); out.empty() || row > out.back())
                out.push_back(row);
        first = end;
    }
    return out;
}

/// Of these arrivals the ones whose set-points change most, no two closer than a pulse lasts.
inline std::vector<std::size_t> largest_steps(std::span<const double> asked,
                                              const std::vector<std::size_t>& arrival, std::size_t apart) {
    constexpr std::size_t enough = 8;
    const auto step = [&](std::size_t row) { return std::abs(asked[row] - asked[row - 1]); };
    std::vector<std::size_t> order, out;
    for (std::size_t row : arrival)
        if (row >= apart && row + 2 * apart < asked.size() && step(row) > 0) order.push_back(row);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return step(a) > step(b); });
    for (std::size_t row : order) {
        if (out.size() == enough) break;
        const auto near = [&](std::size_t other) {
            return std::max(row, other) - std::min(row, other) < apart;
        };
        if (std::none_of(out.begin(), out.end(), near)) out.push_back(row);
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
