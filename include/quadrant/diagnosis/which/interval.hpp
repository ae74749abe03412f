// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../result/result.hpp"
#include "candidate.hpp"

namespace quadrant::inline v0::diagnosis {

/// Covariance of the fitted parameters, in fit coordinates: H^-1 (S + P) H^-1 with H the curvature of the
/// score, S the scatter of the gradient between motion segments and P the owner's tolerance. Segments, not
/// samples, carry the scatter, so that correlated residuals and what the model lacks widen it.
QUADRANT_DIAGNOSIS_DECL Eigen::MatrixXd covariance(const candidate& c, const scoring& s);

/// The machine file's keys of one effect with 95 % intervals, through the effect's own reading of the plant.
QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> estimates(const candidate& c, const effect& e,
                                                                  const scoring& s);

/// Marks the values that stopped at the end of what they were allowed: the fit would have gone on.
QUADRANT_DIAGNOSIS_DECL void mark_bounds(const candidate& c, std::vector<parameter_estimate>& estimates);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "interval.ipp"
#endif
