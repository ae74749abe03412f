// SPDX-License-Identifier: BSL-1.0
#include "plants.hpp"

#include "experiment/stage_cycle.hpp"
#include "experiment/stage_drive.hpp"
#include "experiment/stage_moves.hpp"
#include "experiment/stage_other.hpp"
#include "experiment/stage_tuning.hpp"
#include "experiments.hpp"

std::vector<quadrant_reproduce::experiment> quadrant_reproduce::stage_experiments() {
    return {stage_moves(), stage_cycle(), stage_drive(), stage_other(), stage_tuning()};
}
