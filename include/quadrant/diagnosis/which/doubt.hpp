// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "like_friction.hpp"
#include "rivals.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Force that the best model leaves above the noise, over what cause number `which` explains.
QUADRANT_DIAGNOSIS_DECL double left_beside(const axis_case& c, std::size_t which);
/// The same beside `explained` [N], with what the laws of the other causes may leave: none is better than some
/// five per cent of what it explains. What does not matter to the owner counts against a cause that explains
/// even less.
QUADRANT_DIAGNOSIS_DECL double doubtful_beside(const axis_case& c, double explained);

/// Mean square of what is between the path of a plant and that of a log, where its drive's loops are closed on
/// it.
QUADRANT_DIAGNOSIS_DECL double beside_path(const axis_record& r, const plant_model& plant);
/// What the best model leaves of both logs' paths beside what the cause number `which` explains of them.
QUADRANT_DIAGNOSIS_DECL double left_of_paths(const axis_case& c, std::size_t which);
/// The same of what was measured behind the drive, above its noise, where it explains most; infinite: nothing
/// was measured there, or the cause explains none of it.
QUADRANT_DIAGNOSIS_DECL double left_behind_drive(const axis_case& c, std::size_t which);
/// The smaller of the two: a gain of the drive may be sure in the measured duty although the tolerances allow
/// the path.
QUADRANT_DIAGNOSIS_DECL double left_of_readings(const axis_case& c, std::size_t which);

/// The probability that the cause is none of the suspects: on the log, beside what the name explains here or
/// there; on the hold-out log, where a gap stays open there, beside what it explains here and there. A name
/// that makes that one worse was not the cause there.
QUADRANT_DIAGNOSIS_DECL double unknown(const axis_case& c, std::size_t which);

/// The probability of the models that have the cause or one of its other names, against the best one tried that
/// has
/// none of them: two common effects may do what a rare one does.
QUADRANT_DIAGNOSIS_DECL double against_others(const axis_case& c, const std::vector<rival>& names);

/// What the owner excludes and explains the record better than the cause number `which`.
struct excluded_rival {
    const effect* name = nullptr; ///< of the best of them; null: there is none
    double probability = 0;       ///< that it is there and the cause is not
};
/// The owner's word is evidence too: it is wrong in one of twenty. So a model with the excluded effect in the
/// cause's place, or alone, must be as much better, beyond the margin of what is undecided, before the name
/// falls. One that contains the cause is no rival.
QUADRANT_DIAGNOSIS_DECL excluded_rival excluded_instead_of(const axis_case& c, std::size_t which);

/// Whether a number of a drive's loops, found outside the owner's tolerance, has an interval that reaches into
/// it. A replay is so sensitive to
/// these gains that they are fitted outside a narrow tolerance by what a law is wrong by: such a value is a
/// suspect, no claim.
QUADRANT_DIAGNOSIS_DECL bool may_be_inside_its_tolerance(const axis_case& c,
                                                         const std::vector<parameter_estimate>& found);

/// Whether what an effect does in the best model may be what a law of friction is wrong by. It is not where
/// it is surely there in forces that no such law holds, and takes off half of what is left of them above the
/// noise.
QUADRANT_DIAGNOSIS_DECL bool may_be_friction(const axis_case& c, const effect& e);

/// Whether, on a machine that is within the owner's tolerances without any cause, an effect changes the
/// innovations in every band by less than twice what the best model leaves: then the other numbers did the
/// work.
QUADRANT_DIAGNOSIS_DECL bool drowns_in_the_rest(const axis_case& c, const effect& e);

/// Of a force over the position another one that cancels it: together they are smaller than either. What is
/// left of them is a curve over the position, and any two that differ little in shape make one. Null: none.
QUADRANT_DIAGNOSIS_DECL const effect* cancelled_by(const axis_case& c, const effect& e);

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "doubt.ipp"
#endif
