// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "own_law.hpp"

namespace quadrant::diagnosis {

using own_forces = own_laws; ///< the laws of a model, as the stepper calls them

} // namespace quadrant::diagnosis
