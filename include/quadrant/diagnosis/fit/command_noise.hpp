// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../analysis/frf.hpp"
#include "../../base/version.hpp"
#include "../model/as_reading.hpp"
#include "drive_noise.hpp"
#include "scoring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// White noise that a logged signal may carry, rms: as much as its power density is anywhere, at its lowest
/// in half of the stretches (Hann windows, half overlapped). What moves the axis stands on top of it, steps in
/// few of the stretches; a filter behind the measurement leaves a frequency with less, and then none is
/// assumed. Nor is what the acceleration of this `position` follows, by their coherence: a loop that shakes
/// its axis at every frequency adds no noise. 0 of fewer than 512 rows.
QUADRANT_DIAGNOSIS_DECL double white_noise_in(std::span<const double> x, std::span<const double> position = {});

/// What such noise of a measured command, as a force of rms `force`, leaves in the means of a channel behind an
/// observer around a free mass: rms [m].
QUADRANT_DIAGNOSIS_DECL double command_noise_in(const channel& c, double force, double mass, double period,
                                                double pole);

/// The same of a force that was measured behind this drive, in a channel of what it says of the reading.
QUADRANT_DIAGNOSIS_DECL double tap_noise_in(const channel& c, double force, const drive_model& d, double period,
                                            double pole);

/// Share of the power of such noise that a measurement may have added: no more than the innovations hold in any
/// channel, and no more than they vary by inside the means of the fastest two where reading noise of rms
/// `sigma` does not make it, but a tenth of that. What a controller asks for is as white behind a coarse
/// count, but it moves the axis, and a model that follows it leaves nothing.
QUADRANT_DIAGNOSIS_DECL double share_added_by_measurement(const std::vector<double>& innovation,
                                                          std::span<const channel> channels, double sigma);

/// rms of white noise of rms 1 behind the zero-phase low-pass of the residual force.
QUADRANT_DIAGNOSIS_DECL double white_noise_below(double bandwidth_Hz, double period);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "command_noise.ipp"
#endif
