// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "log.hpp"

#include <algorithm>
#include <cstddef>

namespace quadrant::inline v0::diagnosis {

/// Every n-th row of a log. A reading stays a reading, with its noise and its count; the command, which is held
/// from each row to the next, becomes its mean over the n rows, which keeps its impulse.
inline axis_log thinned(const axis_log& log, std::size_t n) {
    axis_log out = log;
    if (n < 2) return out;
    const std::size_t rows = log.position.size() / n;
    const auto picked = [&](auto& x) {
        if (x.empty()) return;
        for (std::size_t k = 0; k < rows; ++k) x[k] = x[k * n];
        x.resize(rows);
    };
    const auto means = [&](std::vector<double>& x) {
        if (x.empty()) return;
        for (std::size_t k = 0; k < rows; ++k) {
            double sum = 0;
            for (std::size_t j = k * n; j < (k + 1) * n; ++j) sum += x[j];
            x[k] = sum / static_cast<double>(n);
        }
        x.resize(rows);
    };
    const auto marks = [&](std::vector<unsigned char>& x) {
        if (x.empty()) return;
        for (std::size_t k = 0; k < rows; ++k) {
            unsigned char any = 0;
            for (std::size_t j = k * n; j < (k + 1) * n; ++j) any = std::max(any, x[j]);
            x[k] = any;
        }
        x.resize(rows);
    };
    for (auto* x : {&out.reference, &out.position, &out.reference_velocity, &out.reference_acceleration,
                    &out.velocity, &out.motor, &out.controller_reads})
        picked(*x);
    for (auto* x : {&out.command, &out.other_acceleration, &out.duty, &out.effort, &out.asked}) means(*x);
    marks(out.left_out);
    marks(out.drive_off);
    out.as_sampled = false;
    return out;
}

} // namespace quadrant::inline v0::diagnosis
