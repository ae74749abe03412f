// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Periods at which a signal repeats along z (a position), the strongest first: the signal is gathered in bins
/// of z, a quarter of the shortest period wide, and transformed; `shortest` to `longest`, `count` at most. A
/// bin adds up what falls into it, so that places where the axis dwells weigh more, as in a sum over rows.
QUADRANT_DIAGNOSIS_DECL std::vector<double> spatial_peaks(std::span<const double> signal,
                                                          std::span<const double> z, double longest,
                                                          double shortest, std::size_t count,
                                                          std::size_t skip = 0);

/// Periods at which a signal follows carrier(k) (a cos + b sin)(2 pi z/period), the strongest first: by how
/// much of the signal's energy the least squares of a and b take, beside a constant times the carrier. A
/// carrier that is large in few places (a command that accelerates at the ends of strokes) looks at the wave
/// through a comb of windows, whose side lobes are higher than other lines of a plain transform.
QUADRANT_DIAGNOSIS_DECL std::vector<double>
carried_peaks(std::span<const double> signal, std::span<const double> carrier, std::span<const double> z,
              double longest, double shortest, std::size_t count, std::size_t skip = 0);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "spatial_spectrum.ipp"
#endif
