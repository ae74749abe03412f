// SPDX-License-Identifier: BSL-1.0
#include "plants.hpp"

#include "experiment/adaptation.hpp"
#include "experiment/bands.hpp"
#include "experiment/chapters.hpp"
#include "experiments.hpp"

std::vector<quadrant_reproduce::experiment> quadrant_reproduce::other_machine_experiments() {
    return {chapters(), adaptation(), bands()};
}
