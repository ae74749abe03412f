// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "predictor.hpp"

namespace quadrant::inline v0::diagnosis {

/// Residual force M (a_model - a_measured): what the model pushes and the machine did not follow [N], both
/// accelerations through the identical zero-phase filter. Both are second differences of positions, so that a
/// right model leaves the encoder's rounding only. Rows that are left out (axis_record::left_out) count as if
/// nothing were left there.
QUADRANT_DIAGNOSIS_DECL std::vector<double> residual_force(const plant_model& plant,
                                                           std::span<const double> position,
                                                           std::span<const double> model_acceleration,
                                                           double period, double bandwidth_Hz,
                                                           std::span<const unsigned char> left_out = {});

/// rms of residual_force() when the position carries white noise of `sigma` and nothing else is wrong.
/// `reaction`: of a drive whose replay is fed the position.
QUADRANT_DIAGNOSIS_DECL double residual_force_floor(double mass, double sigma, double period,
                                                    double bandwidth_Hz, std::span<const double> reaction = {});

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "residual_force.ipp"
#endif
