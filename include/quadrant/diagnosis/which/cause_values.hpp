// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/signals.hpp"
#include "../result/result.hpp"
#include "axis_case.hpp"
#include "rivals.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Harmonics reported with their own period (detail::repeats_in_its_period).
QUADRANT_DIAGNOSIS_DECL void in_lowest_terms(std::vector<parameter_estimate>& values);

/// The scatter of the segments does not show the error of a law that is a little wrong. No value is better than
/// one per cent, none better than what is left beside what its effect explains (worst case: the whole residual
/// biases this parameter), no length better than half a count. An angle moves by as much in radian.
QUADRANT_DIAGNOSIS_DECL void add_model_error(std::vector<parameter_estimate>& values, const effect& e,
                                             const axis_case& c, double left);

/// Intervals of the same values under another reading belong to theirs.
QUADRANT_DIAGNOSIS_DECL void widen(std::vector<parameter_estimate>& mine,
                                   const std::vector<parameter_estimate>& other);

/// Whether the record leaves the frequency or the period of a cause open: its interval is as wide to either
/// side as the value, so that none of a shorter period is distinguished from it.
QUADRANT_DIAGNOSIS_DECL bool is_undetermined(const std::vector<parameter_estimate>& values);

/// Whether the interval of what a cause adds reaches the value at which it adds nothing: the record does not
/// say that it is there.
QUADRANT_DIAGNOSIS_DECL bool may_be_nothing(const std::vector<parameter_estimate>& values);

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "cause_values.ipp"
#endif
