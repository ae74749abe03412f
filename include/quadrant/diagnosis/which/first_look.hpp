// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "candidate.hpp"

#include <optional>
#include <vector>

namespace quadrant::inline v0::diagnosis {

namespace detail {
/// The first of these starts whose numbers another fit has all found, begun there; none, where it found others
/// or they are those of that start.
QUADRANT_DIAGNOSIS_DECL std::optional<std::vector<parameter>>
begun_where(const fit_result& found, const std::vector<std::vector<parameter>>& starts);
} // namespace detail

/// First looks at `from` with one more effect, to be run by the fitter: a step or two from every start that it
/// offers, or from where a fit has `found` it by itself; the slopes of the parameters that `from` has taken
/// from there. None: the effect offers no start.
QUADRANT_DIAGNOSIS_DECL std::vector<fit_course> first_looks(const fitter& fit, const candidate& from,
                                                            const effect& added, const screening& look,
                                                            const shared_slopes& slopes, int steps,
                                                            const fit_result* found = nullptr);

namespace detail {
/// Takes what the starts of one model came to: the best, less what its numbers cost, and beside it the best of
/// each other set of numbers that they free, where that gained nearly as much over `from`, this `share`. Looks
/// are two steps long: with one gain of a drive a model may be ahead that a fit to the end finds behind.
QUADRANT_DIAGNOSIS_DECL void take_best(candidate& sketch, const candidate& from, std::span<fit_course> starts,
                                       double share);
} // namespace detail

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "first_look.ipp"
#endif
