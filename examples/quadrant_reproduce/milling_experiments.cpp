// SPDX-License-Identifier: BSL-1.0
#include "experiment/cutting.hpp"
#include "experiment/robustness.hpp"
#include "experiment/sensitivity.hpp"
#include "experiments.hpp"

std::vector<quadrant_reproduce::experiment> quadrant_reproduce::milling_experiments() {
    return {cutting(), robustness(), sensitivity()};
}
