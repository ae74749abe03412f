// SPDX-License-Identifier: BSL-1.0
#include "experiment/vcnc_contour.hpp"
#include "experiment/vcnc_fuzzy.hpp"
#include "experiment/vcnc_margins.hpp"
#include "experiment/vcnc_other.hpp"
#include "experiment/vcnc_parts.hpp"
#include "experiment/vcnc_program.hpp"
#include "experiments.hpp"

std::vector<quadrant_reproduce::experiment> quadrant_reproduce::vcnc_experiments() {
    return {vcnc_parts(), vcnc_contour(), vcnc_program(), vcnc_margins(), vcnc_fuzzy(), vcnc_other()};
}
