// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "compare/comparison_result.hpp"
#include "effect/rules.hpp"
#include "log/log.hpp"
#include "machine/machine.hpp"

namespace quadrant::inline v0::diagnosis {

/// Names what differs between two logs of axes with the same description, whatever their motions, lengths and
/// sample rates. Each log is explained by its own diagnosis; the machine with everything that one log shows,
/// claims and suspects, is then the description of the other, both ways round. A difference is named where
/// both logs ask for it: the one is explained better with it, the other worse, each by `rules::margin` and
/// `rules::least_shrink`, and no machine that either log shows explains both as well. What lies inside the
/// owner's tolerances is no difference. Machine and logs match (match.hpp); the second log may have another
/// period (it is resampled). Costs four diagnoses.
QUADRANT_DIAGNOSIS_DECL comparison_result compare(const machine_description& machine, const machine_log& first,
                                                  const machine_log& second, const progress& tell = {},
                                                  const rules& r = {});

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "compare.ipp"
#endif
