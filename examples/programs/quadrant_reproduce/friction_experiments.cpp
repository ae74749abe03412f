// SPDX-License-Identifier: BSL-1.0
#include "plants.hpp"

#include "experiment/circle.hpp"
#include "experiment/friction.hpp"
#include "experiment/friction_dob.hpp"
#include "experiment/identification.hpp"
#include "experiments.hpp"

std::vector<quadrant_reproduce::experiment> quadrant_reproduce::friction_experiments() {
    return {friction(), friction_dob(), circle(), slow_circle(), identification()};
}
