// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../result/result.hpp"
#include "axis_case.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Time by which set-points seem to come earlier than described [s], by less than a row; else 0. A drive that
/// measures its velocity as much late does the same: it adds velocity_gain a and velocity_integral v, times
/// that time, to its force, and no file says how late that is.
inline double late_velocity(const axis_case& c, const cause& named) {
    if (named.effect != "command_delay" || !c.axis.drive.has_velocity_loop()) return 0;
    const double earlier =
        c.models.given().fit.plant.drive.delay - named.parameters.front().values.front().value;
    return earlier > 0 && earlier < c.record.period ? earlier : 0;
}

} // namespace quadrant::inline v0::diagnosis::detail
