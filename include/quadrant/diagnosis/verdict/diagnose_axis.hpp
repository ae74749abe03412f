// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../chain/diagnose_chain.hpp"
#include "../text/progress.hpp"
#include "../which/axis_case.hpp"
#include "../which/stages.hpp"
#include "tell_turning_inertia.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// From the models of an axis to its verdict, its causes, what is left and the motion that would tell more.
/// `tell` is of the whole axis. `of_transmission`: what the two encoders of the axis say, where it has two.
QUADRANT_DIAGNOSIS_DECL void diagnose_axis(diagnosis_result& out, axis_case& c, const progress& tell,
                                           const stages& stage, chain::two_encoders* of_transmission = nullptr,
                                           const other_axes& others = {});

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "diagnose_axis.ipp"
#endif
