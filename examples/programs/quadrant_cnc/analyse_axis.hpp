// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "analysis_result.hpp"
#include "frf_file.hpp"

namespace quadrant_cnc {

/// Frequency and time domain of one axis. `step_m`: of the reference; 0: what takes half of the limit.
/// `measured` stands in for the drive in the frequency domain; null: none.
axis_analysis analyse_axis(const axis_description& a, double period, std::uint64_t seed, double step_m,
                           const frf_file* measured);

} // namespace quadrant_cnc
