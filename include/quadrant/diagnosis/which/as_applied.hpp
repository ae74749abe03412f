// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "causes.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// These effects on top of `from`, each time the one that takes most off the force on held-out motion. One that
/// cannot be identified without the others comes after them.
QUADRANT_DIAGNOSIS_DECL std::vector<candidate> by_share(const axis_case& c, const candidate& from,
                                                        std::vector<const effect*> effects);

/// The name that heads a group: the most probable one. A number that ends where its search ends has not been
/// found: the name only does there what another one does (a Stribeck velocity above every speed is Coulomb
/// friction), so that it comes after one whose numbers were found.
QUADRANT_DIAGNOSIS_DECL const rival& heading(const std::vector<rival>& group);

} // namespace detail

/// The rivals of each cause of the best model. A group is headed by its most probable name: where another name
/// of a cause weighs more, the model with that name takes its place, as many times as there may be causes.
QUADRANT_DIAGNOSIS_DECL std::vector<std::vector<detail::rival>> rivals_by_weight(axis_case& c);

/// Puts what apply will write first: the claims, the one that takes most off before the others, fitted without
/// the suspects, which follow. `causes` and `rivals` come into the same order, and the claims get the values of
/// that fit.
QUADRANT_DIAGNOSIS_DECL void put_as_applied(axis_case& c, std::vector<cause>& causes,
                                            std::vector<std::vector<detail::rival>>& rivals);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "as_applied.ipp"
#endif
