// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../effect/described_numbers.hpp"
#include "../which/chance.hpp"
#include "reversals.hpp"

/// What is said of one link: causes, places, verdict.
namespace quadrant::inline v0::diagnosis::chain {

/// What was found on one link, in the words of a diagnosis.
struct outcome {
    quadrant::diagnosis::verdict verdict = verdict::no_gap;
    gap_numbers gap, gap_after; ///< of positions
    std::vector<cause> causes;
    std::vector<place> places; ///< of the block view, of reversals and of the travel
    std::vector<parameter_estimate> calibrated;
    std::vector<std::string> notes;
    double share_left = 0; ///< of the gap's energy
    std::string structure;
    std::vector<double> difference,
        left; ///< one entry a row: last - first without its mean, and what the best model leaves [m]
    std::vector<double>
        elastic; ///< how far load and motor are apart, one entry a row; empty: they move as one [m]
    double play = 0, compliance = 0; ///< of the best model [m], [m/N]
    link_model best{};               ///< as found
    /// Friction of the motor that was found though its owner excludes it: the force overcomes it as well [N].
    std::optional<double> unnamed_motor_coulomb{};
};

/// How far the load is from the motor, at every row, but for what the readings alone make: their zeros and
/// their moments [m].
QUADRANT_DIAGNOSIS_DECL std::vector<double> apart(const readings& r, const fitted& f);

/// The signals of the pictures, at every row that counts.
QUADRANT_DIAGNOSIS_DECL void give_signals(outcome& out, const readings& r, const fitted& f);

/// A finding as a cause.
QUADRANT_DIAGNOSIS_DECL cause cause_of(const described_link& d, const answer& a, const axis_description& axis,
                                       const finding& f);

/// What is said of a finding that no name stands for: a drift over time, or readings of two moments.
QUADRANT_DIAGNOSIS_DECL std::string note_without_name(const described_link& d, const answer& a,
                                                      const axis_description& axis, term what);

/// A link whose described numbers are moved, inside their tolerances, to where they fit the readings best, all
/// of them together: play and stiffness that are both a little off look like a third cause. `moved` gets those
/// that were moved, where that pays; else the link is left as it is.
QUADRANT_DIAGNOSIS_DECL described_link calibrated_link(const readings& r, const described_link& d,
                                                       const axis_description& axis, const rules& limits,
                                                       std::vector<parameter_estimate>& moved);

/// One link diagnosed.
QUADRANT_DIAGNOSIS_DECL outcome diagnose_link(const described_link& d, const axis_description& axis,
                                              const std::vector<std::string>& excluded, const rules& limits);

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "outcome.ipp"
#endif
