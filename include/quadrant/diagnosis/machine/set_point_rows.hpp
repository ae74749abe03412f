// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_description.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Where the set-points in a log's rows come several times in each of them and nothing says how often: as if so
/// often. Of more the rows show nothing.
inline constexpr double set_points_in_a_row = 10;

/// Every how many rows a column of set-points changes while it changes at all; 1: in every row, or at no steady
/// rate.
inline std::size_t rows_of_a_set_point(std::span<const double> x) {
    constexpr std::size_t longest = 64, enough = 50;
    std::array<std::size_t, longest + 1> times{};
    std::size_t all = 0, last = 0;
    for (std::size_t k = 1; k < x.size(); ++k) {
        if (x[k] == x[k - 1]) continue;
        if (last > 0 && k - last <= longest) ++times[k - last], ++all;
        last = k;
    }
    const auto most = std::max_element(times.begin(), times.end());
    const bool steady = all >= enough && 20 * *most >= 19 * all;
    return steady ? static_cast<std::size_t>(most - times.begin()) : 1;
}

/// In which row of each set-point's rows a column changes: a recorder begins at any of them. 0: it changes in
/// every row, or at no steady rate.
inline std::size_t row_of_change(std::span<const double> column, double every) {
    const auto rows = static_cast<std::size_t>(std::lround(every));
    if (rows < 2 || std::abs(every - static_cast<double>(rows)) > 1e-6) return 0;
    std::vector<std::size_t> changes(rows, 0);
    std::size_t all = 0;
    for (std::size_t k = 1; k < column.size(); ++k)
        if (column[k] != column[k - 1]) ++changes[k % rows], ++all;
    const auto most = std::max_element(changes.begin(), changes.end());
    return all > 0 && 20 * *most >= 19 * all ? static_cast<std::size_t>(most - changes.begin()) : 0;
}

/// Whether a drive may have got set-points between the rows of its log: nothing says how often it gets them,
/// and each row has another one. The registers of a servo are read one after another, which looks alike.
inline bool may_come_between_rows(const drive_description& drive, std::span<const double> set_points) {
    return drive.has_velocity_loop() && !drive.set_point_period_s && rows_of_a_set_point(set_points) == 1;
}

} // namespace quadrant::inline v0::diagnosis
