// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "regression.hpp"

namespace quadrant::inline v0::diagnosis {

/// By how much the column of a measured command stands later than the motion that the command makes [s]; 0: by
/// no more than a row, or not surely. What acts comes before what it does, so a column that fits the motion
/// better if it is read earlier was recorded late: filtered, or sent one cycle after the position. A motion
/// that comes late is another matter: machines have that.
QUADRANT_DIAGNOSIS_DECL double lateness_of_command(const axis_log& log, double period);

/// A log with its command read earlier.
QUADRANT_DIAGNOSIS_DECL axis_log read_earlier(axis_log log, double seconds, double period);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "late_command.ipp"
#endif
