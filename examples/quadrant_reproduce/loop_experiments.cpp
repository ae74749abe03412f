// SPDX-License-Identifier: BSL-1.0
#include "experiment/dob_force.hpp"
#include "experiment/loop_margins.hpp"
#include "experiment/repetitive.hpp"
#include "experiments.hpp"

std::vector<quadrant_reproduce::experiment> quadrant_reproduce::loop_experiments() {
    return {loop(), loop_modes(), loop_dob(), dob_force(), repetitive()};
}
