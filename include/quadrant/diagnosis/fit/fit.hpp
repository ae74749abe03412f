// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "fitter.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// One fit on its way: it asks for the innovations of some plants, takes them, and asks again, until it is
/// done. Many courses that ask at the same time share the lanes of a pass (fitter::run).
class fit_course {
public:
    /// `known`: slopes that are taken as they are instead of being found again. For a first look at one more
    /// effect: the others' slopes are those of the model without it.
    /// `chords`: steps that may be taken with the slopes of an earlier point before they are found again.
    /// Slopes cost a pass for each parameter, a step costs one; the last steps are taken with new slopes in any
    /// case.
    fit_course(const fitter& f, const plant_model& start, const std::vector<parameter>& ps, int iterations,
               known_slopes known = {}, int chords = 4);

    /// Puts the plants that the next step needs behind `plants`; none when the fit is done.
    void ask(std::vector<plant_model>& plants);
    /// Takes their innovations; returns how many it had asked for.
    std::size_t take(std::span<std::vector<double>> innovation, std::span<const double> choices);
    /// Whether it asks for nothing: at its end, or where it pauses.
    bool done() const { return stage_ == stage::done || paused_; }
    fit_result& result() { return best_; }
    int iterations() const { return iterations_; } ///< at most
    /// Pauses behind this many iterations, where others are behind it or before it. It keeps no slopes there.
    void pause_after(int iterations) {
        pause_ = iterations;
        paused_ = false;
    }
    /// Goes on to its own end.
    void go_on() { pause_after(0); }
    /// Ends where it is.
    void end() {
        stage_ = stage::done;
        paused_ = false;
        release();
    }

private:
    enum class stage { begin, trial, slopes, done };

    std::size_t took(std::span<std::vector<double>> innovation, std::span<const double> choices);
    /// What nobody asks a fit for that stands; a first look at its end is not asked for its innovations either.
    void release();
    void take_slopes(std::span<std::vector<double>> moved);
    /// The next iteration, if there is one.
    void next();
    void try_step();
    /// Whether the trial is better; then it is the best, and its damping falls.
    bool compare();
    /// The end of an iteration: whether another follows, and with which slopes.
    void conclude();

    /// A gain beside the margins of the selection that is worth no pass [nats].
    static constexpr double hair = 0.1;
    /// A step that promises less is not tried. Far below the hair: where the score is rough a step gains more
    /// than its quadratics promise.
    static constexpr double least_promise = 1e-3;
    static constexpr int attempts = 6; ///< of one iteration, with more damping each

    const fitter* fitter_;
    known_slopes known_;
    int iterations_, chords_, iteration_ = 0, attempt_ = 0, old_ = 0, pause_ = 0;
    stage stage_ = stage::begin;
    fit_result best_, trial_{};
    std::vector<viewed_signal> slopes_{}; ///< of the parameters behind the known ones
    std::vector<double> step_{};
    std::vector<Eigen::VectorXd> tries_{}; ///< points that are asked for at once, the least damped first
    double damping_ = 1e-3, damping_before_ = 0, since_ = 0,
           gain_ = 0; // since: what was gained with these slopes
    bool better_ = false, paused_ = false;
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "fit.ipp"
#endif
