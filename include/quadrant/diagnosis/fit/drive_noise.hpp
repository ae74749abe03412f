// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/signals.hpp"
#include "predictor.hpp"
#include "scoring.hpp"

#include <algorithm>
#include <numeric>

namespace quadrant::inline v0::diagnosis {

/// What the replay of a drive makes of noise in the position that it is fed: its force for a reading that is
/// wrong by one unit in a single row, in the middle of a record at rest [N/m]. An integral keeps its share to
/// the end.
QUADRANT_DIAGNOSIS_DECL std::vector<double> reaction_to_reading(const plant_model& described,
                                                                const driven_motion& of);

/// The integral of a velocity loop inside a position loop adds up the noise of the position reading: each row
/// adds an independent step to the replayed force, which drifts as far as the record is long. Below the
/// frequency w where this drift exceeds the noise that the reading itself makes of a mass,
///   M w^2 = position_gain velocity_integral / w,
/// no force can be distinguished from it. Returns the pole of the filter that takes the drift out of the
/// innovations; 1: no drift.
QUADRANT_DIAGNOSIS_DECL double drift_pole_of(const plant_model& described, double period);

namespace detail {

/// The innovations that this wrong reading leaves in an observer around a free mass. `reading`: by how much the
/// row in the middle is read wrong; 0: of the force alone.
QUADRANT_DIAGNOSIS_DECL std::vector<double> innovation_of(const std::vector<double>& reaction, double mass,
                                                          double period, double pole, double reading = 1);
/// Means over m rows, from every row that has as many behind it.
QUADRANT_DIAGNOSIS_DECL std::vector<double> running_means(const std::vector<double>& e, std::size_t m);
/// Gains of a channel for noise that makes these innovations of a single wrong reading: of white noise, and of
/// the worst tone.
QUADRANT_DIAGNOSIS_DECL void set_gains(channel& c, const std::vector<double>& e);

} // namespace detail

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "drive_noise.ipp"
#endif
