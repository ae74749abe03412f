// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../where/places.hpp"
#include "axis_case.hpp"

namespace quadrant::inline v0::diagnosis {

/// The gap by box of the loop. Replay separates the controller from everything behind the command; what lies
/// behind is divided by what each cause takes off the residual's energy, as `basis` says. The largest share
/// comes first; what no cause explains stays with an empty block.
QUADRANT_DIAGNOSIS_DECL std::vector<place> block_places(const axis_case& c);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "block_places.ipp"
#endif
