// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../compensate/compensation_result.hpp"
#include "links.hpp"

namespace quadrant::inline v0::diagnosis::chain {

/// What a control can do about the errors between two positions of an axis: it adds a step at each reversal,
/// adds a table along the travel, or counts with another travel of a turn. Forecast on the readings of a log:
/// the logged difference of the two positions, less what the compensation moves the second one by.
///
/// `axis`: as described; `corrected`: with what was found; `inside`, `at_ends`: with values drawn from the
/// intervals of the diagnosis, and at their ends. `effects`: the causes of the axis that are to be compensated.
QUADRANT_DIAGNOSIS_DECL compensated_axis compensated_positions(
    const axis_description& axis, const axis_description& corrected, const axis_log& log, double period,
    const std::string& file, const std::vector<const axis_description*>& inside,
    const std::vector<const axis_description*>& at_ends, const std::vector<std::string>& effects);

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "position_compensation.ipp"
#endif
