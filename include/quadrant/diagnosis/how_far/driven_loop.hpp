// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../model/closed_drive.hpp"
#include "closed_loop.hpp"

#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Whether a loop can be simulated from what the log asks for: a position drive follows its set-points, a
/// velocity drive needs the controller that closes the position.
QUADRANT_DIAGNOSIS_DECL bool can_close(const axis_description& axis, const axis_log& log);

/// The axis with its drive's loops closed inside the plant, on a clock finer than the log's, started where the
/// log starts. `command` of the result is what the actuator gets, mean over each row. Noise of the sensor [m],
/// one entry a row, is in the reading before it is rounded to a count. `set_points`, where it is given, gets
/// what the drive was asked for in each row.
QUADRANT_DIAGNOSIS_DECL closed_loop_run simulate_driven(const axis_description& axis, const plant_model& plant,
                                                        double period, const axis_log& log,
                                                        std::span<const double> sensor_noise = {},
                                                        std::vector<double>* set_points = nullptr);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "driven_loop.ipp"
#endif
