// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/signals.hpp"
#include "../where/places.hpp"
#include "../which/causes.hpp"
#include "../which/read_off.hpp"
#include "driven_loop.hpp"

#include <span>

namespace quadrant::inline v0::diagnosis {

/// How far the gap shrinks: the gap of the machine file as given, after each cause, and with everything added,
/// in force, position and command. On the hold-out log when there is one, else on motion segments predicted by
/// parameters that were fitted without them.
class how_far {
public:
    explicit how_far(const axis_case& c)
        : case_(c), log_(c.holdout ? *c.holdout : c.log), judged_(c.second ? *c.second : c.record),
          draws_(segment_draws(judged_.segments)) {}

    void measure(axis_result& result, std::vector<cause>& causes) const;
    /// Whether 97.5 of 100 draws of the motions leave no more force with the model `to` than with `from`, noise
    /// apart, and the interval of the gain reaches less than half as far below zero as above it.
    bool surely_shrinks(const candidate& from, const candidate& to) const;
    /// Position error times command error of the closed loop on the calibrated machine, and with each cause
    /// more. Empty where the loop cannot be closed, and where samples are lost: others in each run.
    std::vector<double> loop_errors() const;

private:
    struct stage {
        double mass; ///< of the model [kg]
        std::vector<double> force;
        std::optional<closed_loop_run> loop;
    };

    /// The fitted plant, from where the record begins that is judged.
    plant_model plant_of(const candidate& model) const;
    /// Residual force with this model.
    std::vector<double> force(const candidate& model) const;
    stage at(const candidate& model, const std::optional<controller_description>& controller) const;
    std::optional<closed_loop_run> loop(const plant_model& plant,
                                        const std::optional<controller_description>& controller) const;
    static std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b);
    /// By how much the sizes of two signals differ, block by block. A loop with a play chatters where its model
    /// does, as much, and at other moments.
    double apart_in_size(const std::vector<double>& a, const std::vector<double>& b) const;
    segment_energy energy(const std::vector<double>& x) const;
    estimate interval(const segment_energy& e) const;
    void compare(cause& c, const segment_energy& before, const segment_energy& after) const;
    static void compare(cause& c, const segment_energy& before, const segment_energy& after,
                        std::size_t segments);
    void compare(cause& c, const closed_loop_run& before, const closed_loop_run& after) const;
    /// Where rounding falls no model can predict: its energy is taken off as a whole.
    void compare_rounding(cause& c, const stage& s) const;
    gap_numbers numbers(const stage& s) const;
    void draw(axis_signals& s, const stage& after) const;

    const axis_case& case_;
    const axis_log& log_;
    const axis_record judged_;
    const std::vector<std::vector<double>> draws_;
};

/// What takes the residual force down is right in the loop as well: claims with which the simulated loop goes
/// further from the log than with fewer of them become suspects. `errors`: how_far::loop_errors, of the causes
/// in this order.
QUADRANT_DIAGNOSIS_DECL void doubt_by_loop(std::span<cause> causes, const std::vector<double>& errors);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "how_far.ipp"
#endif
