// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "lanes/math.hpp"
#include "lanes/number.hpp"
#include "lanes/turns.hpp"
#include "lanes/wide.hpp"

/// Many instances of a block at once: `notch<signal::force, lanes<4>>` is four notches, each with its own
/// parameters, input and fault, stepped by one call. This header is all that a program includes for it.
