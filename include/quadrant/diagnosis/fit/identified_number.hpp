// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace quadrant::inline v0::diagnosis {

/// One number of a drive or of the axis that it moves, identified from a record.
struct identified_number {
    std::string key; ///< of a linear axis in a machine file, with its box: "drive.velocity_gain_N_s_per_m"
    double value = 0;
    double low = 0, high = 0; ///< 95 % interval

    double half_width() const { return std::max(high - value, value - low); }
    /// Known to a half of it, a direction to a tenth of a radian.
    bool identified() const {
        return half_width() < (key == "plant.gravity_phase_rad" ? 0.1 : 0.5 * std::abs(value));
    }
    /// Zero lies outside the interval.
    bool present() const { return low > 0 || high < 0; }
};

} // namespace quadrant::inline v0::diagnosis
