// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "proving_ground.hpp"

#include <numeric>

namespace quadrant::inline v0::diagnosis {

/// The motion that distinguishes the names best, whichever of them is true: the one with the largest of the
/// least gains over all pairs and both directions.
struct separation {
    std::size_t motion = 0, tried = 0;
    double gain = 0; ///< log-score
    /// When no motion does: the one that would if one of the names is true. The other may be a special case of
    /// it.
    std::size_t one_way_motion = 0, one_way_truth = 0;
    double one_way_gain = 0;
};

/// Every motion gets a first look with a few steps of each fit; the most promising are then fitted to the end
/// and from anew, until none of the others could do better. Costs n (n - 1) simulations and pairs of fits a
/// motion for n names: for two names and 10 motions of 5 s at 2 kHz some 2 s on one core.
QUADRANT_DIAGNOSIS_DECL separation best_motion(const proving_ground& ground,
                                               const std::vector<planned_motion>& motions,
                                               const std::vector<confusable>& names, std::size_t threads = 0);

namespace detail {

/// The names of one group that are still in question, the most probable first, at most three: each costs its
/// share of the simulations. Two names of one model (docs/formats.md) stand as one where a third name is in
/// question. All are fitted to the end, which the search spares those that showed little at a first look.
QUADRANT_DIAGNOSIS_DECL std::vector<confusable> readings_of(const std::vector<rival>& rivals,
                                                            const axis_record& record);

/// The standard motions for these names. Where an axis hardly slips, the law of its contact shows first, and
/// that of the models is a stand-in: such motions are for names that show there.
QUADRANT_DIAGNOSIS_DECL std::vector<planned_motion> motions_for(const std::vector<confusable>& names,
                                                                std::vector<planned_motion> motions);

QUADRANT_DIAGNOSIS_DECL experiment simulated_experiment(const axis_case& c,
                                                        const std::vector<confusable>& names);

/// The motion to record next, for the first group of names that the record does not distinguish, one that is
/// claimed before one that is not. A name that is only a suspect and has no second reading has nothing to be
/// simulated against: what else it may be has no model. The motion that shows it is then named and no gain is
/// claimed.
QUADRANT_DIAGNOSIS_DECL void propose(diagnosis_result& out, const axis_case& c,
                                     const std::vector<cause>& causes,
                                     const std::vector<std::vector<rival>>& rivals);

} // namespace detail

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "next_experiment.ipp"
#endif
