// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "record.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// The log of one axis with the acceleration of the axis of its kind that moves most beside it: what
/// cross-coupling would follow, the mean of each row and the next: a plant takes it for the time between them.
/// It is filtered two octaves above the bandwidth of the residual force, so that nothing inside the band is
/// lost; what noise it has above it the band leaves out.
inline axis_log with_neighbour(const machine_log& log, const axis_log& own, double period,
                               double bandwidth_Hz) {
    axis_log out = own;
    double most = 0;
    for (const axis_log& other : log.axes) {
        if (other.name == own.name || other.still || other.kind != own.kind) continue;
        auto a = derivative(derivative(zero_phase(other.position, 4 * bandwidth_Hz, period), period), period);
        for (std::size_t k = 0; k + 1 < a.size(); ++k) a[k] = (a[k] + a[k + 1]) / 2;
        if (const double size = rms(a); size > most) {
            most = size;
            out.other_acceleration = std::move(a);
        }
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
