// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "analysis_result.hpp"
#include "measured_loop.hpp"

namespace quadrant_cnc {

/// A notch and gains for a cascade (law cascade_p_pi) around a measured axis: first gains without a notch, then
/// a notch for the highest peak above their crossover, then gains with it. What cannot be had is said.
proposal propose(const frf_file& measured, const axis_description& a, double period);

} // namespace quadrant_cnc
