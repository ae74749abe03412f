// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Solves a x = b for a symmetric, positive a. Its rows have different units: each is scaled by its own size,
/// so that no pivot depends on the units.
QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd solved(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
/// x for a b that is the unit matrix.
QUADRANT_DIAGNOSIS_DECL Eigen::MatrixXd inverted(const Eigen::MatrixXd& a);

/// The step d that minimizes g'd + d'a d / 2 between `low` and `high`, by projection: a component that would
/// leave its bounds is set on the bound, and the others are solved again beside it. Clamping the free
/// solution instead would leave the other components at values that are optimal only beside the unclamped ones.
QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd bounded_step(const Eigen::MatrixXd& a, const Eigen::VectorXd& g,
                                                     const Eigen::VectorXd& low, const Eigen::VectorXd& high);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "bounded_step.ipp"
#endif
