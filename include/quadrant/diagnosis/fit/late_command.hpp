// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "regression.hpp"

namespace quadrant::inline v0::diagnosis {

/// By how much the column of a measured command stands later than the described plant's delay lets it act [s];
/// 0: by less than three quarters of a row, or not surely. What acts comes before what it does, so a column that
/// fits the motion better if it is read earlier was recorded late: filtered, or sent one cycle after the
/// position. A motion that comes late is another matter: machines have that. So do effects that no regression
/// knows, but on the simulated machines of tests/diagnosis/late_command.cpp they move the answer by no more than
/// half a row.
QUADRANT_DIAGNOSIS_DECL double lateness_of_command(const axis_log& log, double period,
                                                   const plant_description& plant);

/// A log with its command read earlier.
QUADRANT_DIAGNOSIS_DECL axis_log read_earlier(axis_log log, double seconds, double period);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "late_command.ipp"
#endif
