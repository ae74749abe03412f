// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../fit/for_machine.hpp"
#include "../log/log.hpp"
#include "../log/sensor_box.hpp"
#include "../where/controller_mismatch.hpp"
#include "own_noise.hpp"
#include "pieces.hpp"
#include "restart.hpp"
#include "search.hpp"
#include "stages.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace quadrant::inline v0::diagnosis {

/// One axis under diagnosis, everything found out once: where its wires disagree and the models on the way
/// from the machine file to its causes. What is said of them (causes.hpp, how_far.hpp, block_places.hpp) only
/// reads it.
class axis_case {
public:
    /// `before`: what was found of this record with fewer names excluded, or before models are led along its
    /// motion.
    axis_case(const axis_description& a, const axis_log& l, const axis_log* other, double period,
              const exclusions& excluded, const rules& r, const progress& tell, held_by how = held_by::readings,
              const axis_case* before = nullptr, std::optional<tap_reading> tap = {});
    axis_case(const axis_case&) = delete; // the record and the models refer to it
    axis_case& operator=(const axis_case&) = delete;

private:
    /// The log made ready. How many independent readings a path holds, only a model near the machine shows: the
    /// error of a wrong one is one long wave. So a first search looks for one. Along a motion the models that
    /// were found `before`, and their causes fitted again along it, are such. `tap`: how that is read, where it
    /// is known.
    axis_record record_of(double period, const exclusions& excluded, const progress& tell, held_by how,
                          const axis_case* before, std::optional<tap_reading> tap);
    /// Of several causes that together predict the hold-out log worse than none, those without which the others
    /// predict it better than none. A weight that was found in one pose of an arm is another in the next, and
    /// speaks against no friction beside it.
    void leave_out_what_the_holdout_denies();
    std::vector<const effect*> denied_{}; ///< left out so
    std::vector<plant_model> known_;      ///< near what the machine does, of that search
    /// How far apart machines inside the owner's tolerances are on the hold-out log's motion.
    const std::vector<double>& cloud_of_second() const;
    mutable std::vector<double> cloud_of_second_{};               ///< found when it is asked for
    mutable std::shared_ptr<const led_motion> measured_motion_{}; ///< likewise
    bool within_its_laws(const axis_record& r, const std::vector<plant_model>& plants) const;
    bool within_its_laws_on_both(std::vector<plant_model> plants) const;
    /// This model, the calibrated machine, and this model with stronger friction.
    std::vector<plant_model> beside_stronger_friction(const plant_model& m) const;

public:
    const axis_description& axis;
    const axis_log& log;
    bool exchanged = false;  ///< `log` is the hold-out log and `holdout` the log
    const axis_log* holdout; ///< on which what was fitted to `log` is judged
    rules limits;
    double count;      ///< the step in which the position really moves [m]
    double resolution; ///< the described one, or the real one where that is coarser [m]
    std::size_t motions = 0, motions_of_second = 0; ///< that the log holds, and the hold-out log
    axis_record record;
    search models;
    std::optional<axis_record> second; ///< the hold-out log
    std::optional<controller_finding> controller;
    std::vector<candidate> path; ///< the calibrated machine, then with one cause more each
    std::size_t claims = 0;      ///< of the causes, the first on the path
    double noise = 0;            ///< white noise of the position [m]
    bool count_unnamed = false; ///< a coarser count than described, and the machine file excludes it as a cause
    bool controller_unnamed = false; ///< replay differs, and the machine file excludes that as a cause
    bool settled = false;            ///< the last model leaves noise, or nothing that matters to the owner
    bool settled_on_second = true;   ///< the same on the hold-out log
    /// What is left speaks against no cause: it does not matter to the owner, and what the causes take off
    /// does.
    bool excused = false;

    const candidate& best() const { return path.back(); }
    /// The model of the claims alone: what apply writes.
    const candidate& applied() const { return path[claims]; }
    /// Takes another way from the machine file to its causes.
    void follow(std::vector<candidate> way);
    /// Whether the hold-out log was kept from the fits, so that it tests what was fitted. Not so where its
    /// motion stands in `log`, too (both_motions()).
    bool tested_apart() const { return second && !(log.drive && !log.drive->begins.empty()); }
    bool coarse() const { return axis.encoder.resolution_m > 0 && count > 1.5 * axis.encoder.resolution_m; }
    /// Whether the steps of the reading are those of the last digit that is written: they say nothing of the
    /// encoder.
    bool counts_digits() const { return count < 1.01 * log.position_step; }
    /// Nothing is left that would matter: noise, or far less than the owner's tolerances make. No other cause
    /// can hide behind the names.
    bool at_floor() const { return settled && settled_on_second; }
    /// What is left is, in every band of both logs, no more than the laws of friction and of the causes are
    /// wrong by: no law is right to better than some five per cent. Above the floor, but explained.
    bool within_its_laws() const;
    /// The same of the machine as calibrated, without any cause: what was found in it says no more than that
    /// its friction follows another law.
    bool calibrated_within_its_laws() const;
    /// Beside the other causes an effect does no more than the law of the described friction may be wrong by:
    /// it refines that law, and is no second cause.
    bool is_error_of_its_law(const effect& e) const;
    /// Whether the machine as calibrated leaves no more, in any band of either log, than machines inside the
    /// owner's tolerances differ by from one another.
    bool calibrated_within_tolerances() const;
    /// Nothing is left that would matter when the claims alone are added: the suspects are not needed.
    bool claims_suffice() const;
    /// What the best model's forces leave along the measured motion, over what those of the calibrated machine
    /// leave there. The same measure for a model that was fitted to the readings and for one that was led.
    double left_along_motion() const;
    /// What the forces of each of these plants leave there, above the noise of a measured command [N].
    std::vector<double> left_along_motion(std::span<const plant_model> some) const;
    /// The same of one model.
    double left_along_motion(const candidate& m) const;
    /// Share of what `from` leaves above the floor that `to` takes off, in energy on held-out motion.
    double takes_off(const candidate& to, const candidate& from) const;
    /// How a model predicts the hold-out log, which nothing was fitted to.
    struct on_second {
        double score = 0;     ///< log-score
        bool settled = false; ///< nothing is left that matters
        double force = 0;     ///< residual, rms [N]
    };
    on_second second_log(const candidate& m) const;
    /// The log-scores alone, of several models.
    std::vector<double> scores_on_second(const std::vector<const candidate*>& some) const;
    /// What a model is worth on motion that it was not fitted to: of this log, and of the hold-out log. Behind
    /// the replay of a drive one that leaves more of the force than the best model is worth nothing.
    double worth(const candidate& m) const;
    /// Score on this log below which a model counts little beside the best, whatever the hold-out log says.
    double least_score() const;
    /// Causes that this log asks for, without which the others predict the hold-out log.
    std::span<const effect* const> denied() const { return denied_; }
    bool controller_differs() const { return controller && controller->differs; }
    bool command_is_added() const { return controller_differs() && controller->is_added(); }
    bool controller_open() const { return controller_differs() && !controller->mended && !command_is_added(); }
    double floor_force() const { return models.floor_force(best()); }
    /// The described controller with the found key corrected.
    controller_description mended() const;
    /// What the corrected controller commands otherwise than this log, as a force on the axis [N]: with the
    /// signal that is added to the command taken off, or not. A constant of the unknown first integral is no
    /// part of it.
    std::vector<double> command_left(bool without_added = true) const;
    /// What a controller commands otherwise than logged, as a force on the axis [N].
    std::vector<double> command_difference(const axis_log& l, const controller_description& c) const;
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "axis_case.ipp"
#endif
