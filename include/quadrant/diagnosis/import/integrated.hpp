// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "foreign_table.hpp"
#include "map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Of an axis without a position: the integral of its velocity, from zero at the first row.
template <class Tell>
void integrate_velocities(const import_map& map, std::vector<foreign_table>& tables, const Tell& tell) {
    for (const auto& a : map.axes) {
        if (a.find(signal_role::position)) continue;
        const import_map::source& v = *a.find(signal_role::velocity);
        const std::string name = a.name + "_vel_" + v.si;
        foreign_table& table = tables[v.file];
        const auto from = std::find_if(table.columns.begin(), table.columns.end(),
                                       [&](const foreign_column& c) { return c.name == name; });
        const std::string unit = v.si.substr(0, v.si.find('_'));
        foreign_column x{a.name + "_pos_" + unit, from->index, from->factor};
        std::vector<double> steps;
        for (std::size_t k = 0; k < table.t.size(); ++k) {
            const double step = k == 0 ? 0 : table.t[k] - table.t[k - 1];
            if (k > 0) steps.push_back(step);
            x.values.push_back(k == 0 ? 0
                                      : x.values.back() + 0.5 * step * (from->values[k - 1] + from->values[k]));
        }
        std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                         steps.end());
        const double most =
            std::abs(*std::max_element(from->values.begin(), from->values.end(),
                                       [](double p, double q) { return std::abs(p) < std::abs(q); }));
        const double digit = from->step() > 0 ? from->step() : 1e-9 * most;
        x.factor = digit > 0 ? 0.5 * digit * steps[steps.size() / 2] : 1; // of the speed over half a row
        x.written.add("1", 1);
        tell(v.file, fmt::format("axis {}: no position: the integral of {} stands for it, zero at the first "
                                 "row; an error of the velocity adds up in it",
                                 a.name, name));
        table.columns.push_back(std::move(x));
    }
}

} // namespace quadrant::inline v0::diagnosis::detail
