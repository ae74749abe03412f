// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/log.hpp"
#include "../model/plant_axis.hpp"
#include "../where/controller_box.hpp"

#include <random>

namespace quadrant::inline v0::diagnosis {

/// Reading of the encoder [m] and command [V] of a simulated loop, one entry a row of the log.
struct closed_loop_run {
    std::vector<double> position, command;
};

/// The whole simulation as its owner would run it: described controller and given plant from the logged
/// reference, started where the log starts. Sub-steps keep stick and the held command apart from the sampling.
/// Periods that lose their command are drawn, always the same ones: which they were on the machine only a log
/// of it can show. Noise of the sensor [m], one entry a row, is in the reading before it is rounded to a count.
/// Behind rows of which nothing is known the loop begins anew; these rows, and readings that do not count, stay
/// as logged.
/// `added`: what a feedforward adds to the controller's command, row by row, before the limit cuts the sum.
QUADRANT_DIAGNOSIS_DECL closed_loop_run
simulate_closed_loop(const controller_description& c, const axis_description& axis, const plant_model& plant,
                     double period, const axis_log& log, std::span<const double> sensor_noise = {},
                     int substeps = 4, std::span<const double> added = {});

/// Rows that do not count become those of the log: no simulation is compared with what nobody read.
QUADRANT_DIAGNOSIS_DECL void put_as_logged(closed_loop_run& run, const axis_log& log);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "closed_loop.ipp"
#endif
