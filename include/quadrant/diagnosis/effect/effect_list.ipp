// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effects.hpp"

namespace quadrant::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::span<const effect* const> every_effect() { return listed_effects; }

} // namespace quadrant::diagnosis
