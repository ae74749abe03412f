// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "compensate/compensation_result.hpp"
#include "log/log.hpp"

namespace quadrant::inline v0::diagnosis {

/// What compensations in the controller would gain: for each cause of a diagnosis that is at least as probable
/// as `at_least` the feedforward with its fitted values, forecast on the reference of a log of the same machine
/// (bad_input as in apply, match and simulate). The plants of the forecast are drawn from the intervals of the
/// diagnosis, while the feedforward has
/// the values found: never the same numbers on both sides. A cause without a feedforward gets advice and no
/// gain.
QUADRANT_DIAGNOSIS_DECL compensation_result compensate(const machine_description& machine,
                                                       const diagnosis_result& d, const machine_log& log,
                                                       double at_least = 0.5);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "compensate.ipp"
#endif
