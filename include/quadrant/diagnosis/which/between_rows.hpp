// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/with_drives.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Whether the force of a described velocity loop comes and goes between two rows, and nothing measured shows
/// it.
inline bool answers_between_rows(const axis_description& a, const axis_log& log, double period) {
    return !shows_the_force(a, log) && a.answer_of_loop() < period;
}

} // namespace quadrant::inline v0::diagnosis::detail
