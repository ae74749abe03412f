// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../how_far/how_far.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// A name with which the simulated loop leaves the log, among the names of these errors of the loop: of the
/// calibrated machine, then with one name more each. A later name may bring the loop back to its log.
struct loop_accusation {
    std::size_t which = 0;
    double times = 0; ///< as far from the log as without it: position times command
};
inline std::optional<loop_accusation> accused_by_loop(std::span<const double> errors, double least) {
    std::optional<loop_accusation> out;
    for (std::size_t i = 1; i < errors.size(); ++i)
        if (const double times = std::min(errors[i], errors.back()) / errors[i - 1]; times > least) {
            least = times;
            out = {i - 1, times};
        }
    return out;
}

/// What the simulated loop says of the names. A motor that hardly answers its command predicts the readings of
/// an axis that other forces hold, and hides their names.
struct loop_witness {
    const effect* against = nullptr;
    std::size_t which = 0; ///< of the names
    bool surely = false;   ///< a hundred times as far from the log as without it
    /// Of the loop with all names; infinite where it cannot be simulated.
    double error = std::numeric_limits<double>::infinity();

    explicit loop_witness(const axis_case& c) {
        if (!c.axis.controller && !c.axis.drive.closes()) return; // no loop is described
        std::vector<double> errors = how_far(c).loop_errors();
        if (errors.empty()) return;
        for (double& e : errors)
            if (std::isnan(e)) e = std::numeric_limits<double>::infinity();
        error = errors.back();
        constexpr double further = 1.2, far = 100;
        const auto accused = accused_by_loop(errors, c.at_floor() || c.within_its_laws() ? far : further);
        if (!accused) return;
        which = accused->which;
        against = c.best().effects[which];
        surely = accused->times > far;
    }
};

} // namespace quadrant::inline v0::diagnosis::detail
