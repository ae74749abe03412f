// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../result/resample.hpp"
#include "axis_case.hpp"
#include "interval.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// A model in which one cause is exchanged for another name.
struct rival {
    candidate model;
    const effect* name = nullptr;
    double weight = 0;
    bool same = false;     ///< not distinguished from the cause by this record
    bool unlikely = false; ///< then: beside the others that are not; not told

    bool unlisted() const { return name->box.empty(); } ///< a form that no name stands for
};

inline double square(double x) { return x * x; }

/// Whether the forces of a model stand along the measured motion as well as in its predictions: a play hides
/// the motor's motion, and an error of the reading is no force.
inline bool shows_along_motion(const candidate& m) {
    const auto reads = [](const effect* e) { return e->joins == joint::reading; };
    return !(m.fit.plant.backlash > 0) && std::none_of(m.effects.begin(), m.effects.end(), reads);
}

/// Weights of the rivals: softmax of their tempered held-out scores, averaged over draws of whole segments
/// (pseudo-BMA with a bootstrap, Yao et al. 2018): a name that wins by a hair on correlated data has not won. A
/// hold-out log counts as it stands.
QUADRANT_DIAGNOSIS_DECL void weigh(std::vector<rival>& rivals, const axis_case& c);

/// Whether a model frees all that the effect `e` freed in another: it holds that effect and more.
QUADRANT_DIAGNOSIS_DECL bool contains(const candidate& model, const candidate& other, const effect& e);

/// Force that takes `before` to `after`, in energy.
QUADRANT_DIAGNOSIS_DECL double between(double before, double after);
/// What the cause number `which` explains, in force on held-out motion. Where the model without it stops at the
/// end of a tolerance, calibration bent as far as it may to what the cause does, and hides some of it: there it
/// is what the best model leaves when the cause's own numbers go back to what is described.
QUADRANT_DIAGNOSIS_DECL double explained_by(const axis_case& c, std::size_t which);
/// The cause number `which` of the best model and its rivals: the model with this cause exchanged for each
/// other suspect, the others kept. The first entry is the cause itself. A model that contains the cause is no
/// other name for it.
QUADRANT_DIAGNOSIS_DECL std::vector<rival> rivals_of(const axis_case& c, std::size_t which);

/// What is left above the noise beside it.
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

/// Harmonics reported with their own period: where the odd ones hold less than a hundredth of the energy, the
/// even ones alone repeat twice as often.
QUADRANT_DIAGNOSIS_DECL void in_lowest_terms(std::vector<parameter_estimate>& values);

/// The scatter of the segments does not show the error of a law that is a little wrong. No value is better than
/// one per cent, none better than what is left beside what its effect explains (worst case: the whole residual
/// biases this parameter), no length better than half a count. An angle moves by as much in radian.
QUADRANT_DIAGNOSIS_DECL void add_model_error(std::vector<parameter_estimate>& values, const effect& e,
                                             const axis_case& c, double left);

QUADRANT_DIAGNOSIS_DECL void widen(std::vector<parameter_estimate>& mine,
                                   const std::vector<parameter_estimate>& other);

/// Whether a number of a drive's loops, found outside the owner's tolerance, has an interval that reaches into
/// it. A replay is so sensitive to
/// these gains that they are fitted outside a narrow tolerance by what a law is wrong by: such a value is a
/// suspect, no claim.
QUADRANT_DIAGNOSIS_DECL bool may_be_inside_its_tolerance(const axis_case& c,
                                                         const std::vector<parameter_estimate>& found);

/// Whether, on a machine that is within the owner's tolerances without any cause, an effect with all other
/// numbers kept does less than twice of what is left, in every band: it led the fit, and the others took the
/// rest off.
QUADRANT_DIAGNOSIS_DECL bool drowns_in_the_rest(const axis_case& c, const effect& e);

/// Causes that nothing has tested are suspects, as are those that a test contradicts.
QUADRANT_DIAGNOSIS_DECL void to_suspects(std::span<cause> causes);

} // namespace detail

/// The causes behind the command wire, in the order of the path, with probabilities, intervals and second
/// readings. `rivals`: of each, the models that it is weighed against (detail::rivals_of).
QUADRANT_DIAGNOSIS_DECL std::vector<cause> plant_causes(const axis_case& c,
                                                        const std::vector<std::vector<detail::rival>>& rivals);

/// What rounding to a count alone leaves in the residual force [N].
QUADRANT_DIAGNOSIS_DECL double rounding_force(const axis_case& c, double count);

/// An encoder that counts in coarser steps than described: the positions are multiples of the coarser count,
/// which needs no dynamics to see.
QUADRANT_DIAGNOSIS_DECL std::optional<cause> count_cause(const axis_case& c);

/// A signal that is added to the command, where that is more probable than another controller.
QUADRANT_DIAGNOSIS_DECL cause added_cause(const axis_case& c);

/// The controller, when it is not the one described. Replay is deterministic: a key that brings it back to
/// rounding is the cause; one that does not is a guess.
QUADRANT_DIAGNOSIS_DECL std::optional<cause> controller_cause(const axis_case& c);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "causes.ipp"
#endif
