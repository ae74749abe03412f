// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../fit/record.hpp"
#include "calibration.hpp"

#include <random>

namespace quadrant::inline v0::diagnosis {

/// How far apart machines are that the owner calls the same: mean square, by channel, of the innovations by
/// which a machine drawn from inside the bounds of these numbers differs from the calibrated one on the motion
/// of a record; 19 of 20 differ less [m^2]. The gains of a drive's loops count where what the drive gives was
/// measured: they do not move the axis along its path.
QUADRANT_DIAGNOSIS_DECL std::vector<double>
cloud_of_like_machines(const axis_record& r, const plant_model& calibrated, std::span<const parameter> numbers);
/// The same behind a drive where numbers of the record are fitted to every machine, as a search fits them: what
/// these take off a difference is none.
QUADRANT_DIAGNOSIS_DECL std::vector<double> cloud_of_fitted_machines(const axis_record& r,
                                                                     const plant_model& calibrated,
                                                                     std::span<const parameter> numbers);

namespace detail {

/// Twenty such machines. `with_loops`: with other gains of the drive's loops, too.
QUADRANT_DIAGNOSIS_DECL std::vector<plant_model>
like_machines(const plant_model& calibrated, std::span<const parameter> numbers, bool with_loops);

/// Takes what the record's own numbers do out of signals: by least squares in the rows of what was measured
/// behind the drive, each number inside its bounds.
QUADRANT_DIAGNOSIS_DECL void take_out_numbers_of_record(std::vector<std::vector<double>>& signals,
                                                        const axis_record& r, const plant_model& calibrated,
                                                        std::span<const parameter> numbers);

} // namespace detail

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "like_machines.ipp"
#endif
