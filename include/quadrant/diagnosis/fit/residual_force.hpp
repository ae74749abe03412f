// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "predictor.hpp"

#include <algorithm>
#include <cmath>

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

/// The same of axes of any mass: how the squares of what a mass and what a drive's replay make of one wrong
/// reading add up.
struct force_floors {
    double of_mass = 0, of_both = 0, of_reaction = 0;

    force_floors() = default;
    QUADRANT_DIAGNOSIS_DECL force_floors(double period, double bandwidth_Hz, std::span<const double> reaction);
    double operator()(double mass, double sigma) const {
        return sigma * std::sqrt(std::max(0.0, mass * (mass * of_mass - 2 * of_both) + of_reaction));
    }
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "residual_force.ipp"
#endif
