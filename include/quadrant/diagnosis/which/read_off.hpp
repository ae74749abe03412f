// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../result/result.hpp"
#include "axis_case.hpp"

namespace quadrant::inline v0::diagnosis {

/// What rounding to a count alone leaves in the residual force [N].
QUADRANT_DIAGNOSIS_DECL double rounding_force(const axis_case& c, double count);

/// An encoder that counts in coarser steps than described: the positions are multiples of the coarser count,
/// which needs no dynamics to see.
QUADRANT_DIAGNOSIS_DECL std::optional<cause> count_cause(const axis_case& c);

/// A signal that is added to the command, where that is more probable than another controller.
QUADRANT_DIAGNOSIS_DECL cause added_cause(const axis_case& c);

/// The controller, when it is not the one described. Replay is deterministic: a key that brings it back to
/// rounding is the cause; one that does not is a guess.
QUADRANT_DIAGNOSIS_DECL std::optional<cause> controller_cause(const axis_case& c);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "read_off.ipp"
#endif
