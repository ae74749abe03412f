// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/plant/linear_motor.hpp>

/// The plants in whose sub-steps two thirds of a run are spent: made once, in plants.cpp, which is optimised
/// more than the rest. Every file of experiments includes this first.
namespace quadrant::inline v0 {
extern template class linear_motor<maxwell_slip<4>>;
extern template class linear_motor<lugre<>>;
} // namespace quadrant::inline v0
