// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/signals.hpp"
#include "../result/resample.hpp"
#include "axis_case.hpp"
#include "one_speed.hpp"

#include <array>
#include <span>

namespace quadrant::inline v0::diagnosis::detail {

/// A model in which one cause is exchanged for another name.
struct rival {
    candidate model;
    const effect* name = nullptr;
    double weight = 0;
    bool same = false;         ///< not distinguished from the cause by this record
    bool unlikely = false;     ///< of those: too unlikely to be reported
    bool of_one_speed = false; ///< the motion has one speed, at which it is one law with the cause

    bool unlisted() const { return name->box.empty(); } ///< a form that no name stands for
};

/// Whether a number that the name brings ends where its search ends.
inline bool own_number_ends_at_a_bound(const rival& r) {
    for (const key_value& k : r.name->read(r.model.fit.plant))
        if (r.model.ends_at_a_bound(k.key)) return true;
    return false;
}

/// Whether the forces of a model stand along the measured motion as well as in its predictions: a play hides
/// the motor's motion, and an error of the reading is no force.
inline bool shows_along_motion(const candidate& m) {
    const auto reads = [](const effect* e) { return e->joins == joint::reading; };
    return !m.fit.plant.has_play() && std::none_of(m.effects.begin(), m.effects.end(), reads);
}

/// Whether a model moves less under the same command than another, by at least this share. Friction that grows
/// with the load takes its share of the motor's force.
QUADRANT_DIAGNOSIS_DECL bool answers_less(const candidate& m, const candidate& than, double share);

/// Whether a model answers a measured command less than the calibrated machine and leaves more of the forces
/// along the measured motion than the best model. A stiff loop makes a measured command answer every force
/// that a model lacks, and neither that nor the noise of its sensor moves the axis: a heavy model of a weak
/// motor follows no command and predicts the readings well.
QUADRANT_DIAGNOSIS_DECL bool ignores_the_command(const axis_case& c, const candidate& m);

/// Weights of the rivals: softmax of their tempered held-out scores, averaged over draws of whole segments
/// (pseudo-BMA with a bootstrap, Yao et al. 2018): a name that wins by a hair on correlated data has not won. A
/// hold-out log counts as it stands.
QUADRANT_DIAGNOSIS_DECL void weigh(std::vector<rival>& rivals, const axis_case& c);

/// Whether a model frees all that the effect `e` freed in another: it holds that effect and more.
QUADRANT_DIAGNOSIS_DECL bool contains(const candidate& model, const candidate& other, const effect& e);

/// Force that takes `before` to `after`, in energy.
QUADRANT_DIAGNOSIS_DECL double between(double before, double after);
/// The least force that the calibrated machine and the models on the way to cause number `which` leave: a name
/// gets no credit for undoing what another name made worse.
template <typename Force> double least_before(const axis_case& c, std::size_t which, const Force& force) {
    double out = force(c.path.front());
    for (std::size_t i = 1; i <= which; ++i) out = std::min(out, force(c.path[i]));
    return out;
}
/// What the cause number `which` explains, in force on held-out motion. Where the model without it stops at the
/// end of a tolerance, calibration bent as far as it may to what the cause does, and hides some of it: there it
/// is what the best model leaves when the cause's own numbers go back to what is described.
QUADRANT_DIAGNOSIS_DECL double explained_by(const axis_case& c, std::size_t which);
/// What the best model takes off the residual force beside the model without one of its causes, on this log and
/// on the hold-out log, and off the forces along the measured motion: a model that stands still where the axis
/// moves leaves little to its predictions and all of them.
class taken_gap {
public:
    taken_gap(const axis_case& c, const candidate& without) : case_(c), here_(of_log(without, c.best())) {
        if (c.tested_apart()) there_ = of_holdout(without, c.best());
        if (!c.record.observer.led && !c.axis.drive.closes() && shows_along_motion(c.best()) &&
            shows_along_motion(without)) {
            along_ = {square(c.left_along_motion(without)), square(c.left_along_motion(c.best()))};
        }
    }
    /// Whether a model takes at least half of it off, in energy. Asked only of a log on which it is most of
    /// what is there.
    bool is_taken_by(const candidate& m) const {
        return here_.is_taken(case_.models.held_out_force(m)) &&
               (!there_.asked() || there_.is_taken(case_.second_log(m).force)) &&
               (!along_.asked() || !shows_along_motion(m) || along_.is_taken(case_.left_along_motion(m)));
    }

private:
    struct on_a_log {
        double before = 0, after = 0; // in energy
        bool asked() const { return after < before / 2; }
        bool is_taken(double force) const { return !asked() || force * force < (before + after) / 2; }
    };
    on_a_log of_log(const candidate& without, const candidate& best) const {
        return {square(case_.models.held_out_force(without)), square(case_.models.held_out_force(best))};
    }
    on_a_log of_holdout(const candidate& without, const candidate& best) const {
        return {square(case_.second_log(without).force), square(case_.second_log(best).force)};
    }

    const axis_case& case_;
    on_a_log here_, there_{}, along_{};
};

/// The cause number `which` of the best model and its rivals: the model with this cause exchanged for each
/// other suspect, the others kept. The first entry is the cause itself. A model that contains the cause is no
/// other name for it.
QUADRANT_DIAGNOSIS_DECL std::vector<rival> rivals_of(const axis_case& c, std::size_t which);

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "rivals.ipp"
#endif
