// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "analysis_result.hpp"

namespace quadrant_cnc {

/// Frequency and time domain of one axis. `step_m`: of the reference; 0: what takes half of the limit.
axis_analysis analyse_axis(const axis_description& a, double period, std::uint64_t seed, double step_m);

} // namespace quadrant_cnc
