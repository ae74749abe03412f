// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../where/places.hpp"
#include "axis_case.hpp"

namespace quadrant::inline v0::diagnosis {

/// The gap by box of the loop. Replay tells the controller from everything behind the command; what lies behind
/// is told apart by what each cause takes off the residual's energy, and said so in `basis`. The largest share
/// comes first; what no cause tells stays with an empty block.
QUADRANT_DIAGNOSIS_DECL std::vector<place> block_places(const axis_case& c);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "block_places.ipp"
#endif
