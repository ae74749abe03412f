// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../analysis/quadrant_glitch.hpp"
#include "../../base/version.hpp"
#include "../fit/for_machine.hpp"
#include "../how_far/closed_loop.hpp"
#include "../how_far/driven_loop.hpp"
#include "../log/sensor_box.hpp"
#include "../text/on_all_cores.hpp"
#include "../which/restart.hpp"
#include "advice.hpp"
#include "compensation.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Forecasts on one axis of one log. The error that was logged, plus what a compensation changes in the
/// simulated loop: what the simulation does not know stays in the forecast. The simulated sensor and converter
/// are exact, for their rounding is in the log already.
class tracking_forecast {
public:
    tracking_forecast(const axis_description& axis, const axis_log& log, double period);

    const plant_model& plant() const { return plant_; }
    double noise() const { return noise_; }           ///< of the reading [m]
    double resolution() const { return resolution_; } ///< count of the reading [m]

    void run(compensated_axis& out, const std::vector<const axis_description*>& inside,
             const std::vector<const axis_description*>& at_ends) const;

private:
    struct figures {
        double rms = 0, peak = 0, glitch = 0, command = 0;
    };

    closed_loop_run loop(axis_description axis, const plant_model& plant, const std::vector<key_value>& keys,
                         const std::vector<double>& added, const drive_addition& told = {}) const;
    figures changed(const closed_loop_run& bare, const closed_loop_run& with) const;
    figures measure(const std::vector<double>& error, const std::vector<double>& command) const;
    /// Median over the draws. The interval goes from the least of them, and of a plant that is just as found,
    /// to their
    /// largest, wider on both sides by twice what the simulation of the logged loop missed: that is in the
    /// forecast, and in the compensated loop the simulation may miss as much the other way.
    void summarise(compensation& c, const figures& now, const figures& missed, const figures& as_found,
                   const std::vector<figures>& after, std::size_t inside) const;

    const axis_description& axis_;
    const axis_log& log_;
    double period_;
    std::size_t skip_ = 0;
    record_scales scale_;
    plant_model plant_;
    double noise_ = 0, resolution_ = 0;
    std::vector<double> error_;
};

} // namespace detail
} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "tracking_forecast.ipp"
#endif
