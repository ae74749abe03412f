// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../effect/exclusions.hpp"
#include "../effect/rules.hpp"
#include "../fit/record.hpp"
#include "../log/log.hpp"
#include "../machine/machine.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail::beside {

/// How a description, calibrated inside its tolerances, explains a log.
struct fit_of_log {
    double total = 0;      ///< log-score of held-out motion, without anything that was searched for
    double force = 0;      ///< residual, rms [N]
    double floor = 0;      ///< the same of noise and rounding alone [N]
    std::size_t names = 0; ///< suspects of the axis

    double above_floor() const { return std::sqrt(std::max(0.0, force * force - floor * floor)); }
};
/// The force that takes what `less` leaves to what `more` leaves, both above the noise; 0: it grows.
inline double taken_off(const fit_of_log& less, const fit_of_log& more) {
    const double before = less.above_floor(), after = more.above_floor();
    return std::sqrt(std::max(0.0, (before - after) * (before + after)));
}

/// One axis of one log, cut and scaled once, so that every description is scored alike on it.
class log_of_axis {
public:
    log_of_axis(const machine_description& machine, const axis_description& axis, const machine_log& log,
                rules r);
    log_of_axis(const log_of_axis&) = delete; // the record refers to the log
    log_of_axis& operator=(const log_of_axis&) = delete;

    fit_of_log explained_by(const axis_description& axis);

private:
    rules limits_;
    exclusions excluded_;
    axis_log log_;
    axis_record record_;
};

} // namespace quadrant::inline v0::diagnosis::detail::beside

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "fit_of_log.ipp"
#endif
