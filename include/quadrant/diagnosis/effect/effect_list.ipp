// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effects.hpp"

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::span<const effect* const> every_effect() { return listed_effects; }

} // namespace quadrant::inline v0::diagnosis
