// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "with_causes.hpp"

#include <vector>

namespace quadrant::inline v0::diagnosis::detail::beside {

/// What a description says under the keys of these values, as numbers without an interval; empty: nothing.
QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> described(const machine_description& machine,
                                                                  const cause& c);
/// Whether an effect has the same size in both logs, as far as their intervals show. Where something repeats
/// depends on where a log begins to count; a phase is no size.
QUADRANT_DIAGNOSIS_DECL bool same_size(const std::vector<parameter_estimate>& a,
                                       const std::vector<parameter_estimate>& b);
/// Whether a cause, or the other reading of it, is in another diagnosis with the same size.
QUADRANT_DIAGNOSIS_DECL bool is_in(const diagnosis_result& d, const cause& c);
/// What one log shows, with the values of the other log where both show an effect in the same size: as good a
/// description of the first, within its intervals, and no difference for the other. The process is that of the
/// other log.
QUADRANT_DIAGNOSIS_DECL diagnosis_result lent(diagnosis_result d, const diagnosis_result& to);

} // namespace quadrant::inline v0::diagnosis::detail::beside

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "values.ipp"
#endif
