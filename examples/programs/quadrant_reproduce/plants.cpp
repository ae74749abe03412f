// SPDX-License-Identifier: BSL-1.0
#include "plants.hpp"

namespace quadrant::inline v0 {
template class linear_motor<maxwell_slip<4>>;
template class linear_motor<lugre<>>;
} // namespace quadrant::inline v0
