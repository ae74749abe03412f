// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/log.hpp"
#include "../machine/machine.hpp"
#include "identified_number.hpp"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What the path of a record says of the drive that followed it.
struct drive_estimate {
    std::vector<identified_number> numbers;
    interpolation between = interpolation::hold; ///< of the set-points: the better of hold and linear
    std::optional<double> set_point_period_s{};  ///< where they came between the rows of the log, too
    double path_rms = 0;                         ///< between the record and the simulated path [m]
    double path_noise = 0;                       ///< of the reading [m]

    const identified_number* find(std::string_view key) const {
        for (const identified_number& n : numbers)
            if (n.key == key) return &n;
        return nullptr;
    }
};

/// Identifies the numbers of a drive's loops and of the axis that they move: the axis is simulated with its
/// loops closed inside the plant, and its path is fitted to the logged one (output error, Gauss-Newton, from
/// many starts of the loop's speed). A measured duty gives the gain of a servo by regression. The 95 %
/// intervals come from the scatter of the score between 32 parts of the record [Liang1986], so that they hold
/// for residuals of any colour, and are never narrower than what half a step of the simulation's clock does: a
/// drive's own clock is not known. Weak priors of the size of the axis' own forces bound what no row shows;
/// such a number has a wide interval. Forces are known beside one of them only: mass, force constant or gravity
/// is in `known`. `axis` holds what is known, and a placeholder where the machine file needs a number; `known`:
/// keys that are not moved ("plant.mass_kg"); `log`: made ready by with_drive(). Neither a minimum duty, a rate
/// limit of the set-points, a force limit nor a velocity filter is searched for.
QUADRANT_DIAGNOSIS_DECL drive_estimate estimate_drive(const axis_description& axis, const axis_log& log,
                                                      double period, const std::set<std::string>& known);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "drive_estimate.ipp"
#endif
