// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/fit.hpp"

#include <cstddef>
#include <span>

namespace quadrant::inline v0::diagnosis::detail {

/// Runs first looks of some models, `starts_of` each in a row; the best start of a model is what counts. A
/// start that is behind seldom comes back: after half of the `steps` of a look the better half of a model's
/// starts goes on. A look that takes more steps is run whole: the starts of a play change places late.
QUADRANT_DIAGNOSIS_DECL void run_the_promising(const fitter& fit, std::span<fit_course> courses,
                                               std::span<const std::size_t> starts_of, int steps);

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "promising.ipp"
#endif
