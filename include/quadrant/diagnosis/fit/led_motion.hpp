// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <algorithm>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// A motion that plants are led along instead of being corrected by its readings: what an expert's regression
/// does.
struct led_motion {
    std::vector<double> way; ///< smoothed without phase at the corner [m]
    /// What the filter of the forces takes off of its velocity [m/s]: the way is filtered already, and its
    /// viscous friction would be filtered twice.
    std::vector<double> quick;
    std::vector<unsigned char> counts; ///< of every row: 1 where the axis surely moves
    double mass, force_constant;       ///< of the machine file: forces are compared in units of the command

    double share_that_counts() const {
        return static_cast<double>(std::count(counts.begin(), counts.end(), 1)) /
               static_cast<double>(counts.size());
    }
};

} // namespace quadrant::inline v0::diagnosis
