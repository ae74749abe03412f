// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "experiment/circle.hpp"
#include "experiment/cutting.hpp"
#include "experiment/dob_force.hpp"
#include "experiment/friction.hpp"
#include "experiment/friction_dob.hpp"
#include "experiment/identification.hpp"
#include "experiment/loop_margins.hpp"
#include "experiment/repetitive.hpp"
#include "experiment/robustness.hpp"
#include "experiment/sensitivity.hpp"

namespace quadrant_reproduce {

/// All experiments, in the order of the page. A new one is a file in experiment/ and a line here.
inline std::vector<experiment> experiments() {
    std::vector<experiment> all;
    all.push_back(loop());
    all.push_back(loop_modes());
    all.push_back(loop_dob());
    all.push_back(dob_force());
    all.push_back(friction());
    all.push_back(friction_dob());
    all.push_back(circle());
    all.push_back(cutting());
    all.push_back(repetitive());
    all.push_back(identification());
    all.push_back(robustness());
    all.push_back(sensitivity());
    return all;
}

} // namespace quadrant_reproduce
