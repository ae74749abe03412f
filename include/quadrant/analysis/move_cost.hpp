// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <cmath>

namespace quadrant::inline v0::analysis {

/// Fitness of a move as a cost, after [LowKeck2003] eq. (9): weighted mean squares of the tracking error until
/// the move should have ended, of the error after that, and of the command. Its weights are not published.
class move_cost {
public:
    /// The errors and the command that each cost 1, and when the move should have ended.
    struct parameters {
        double tracking; ///< error on the way that costs 1; > 0, as the next two; infinite: none does
        double after;    ///< error after it
        double effort;   ///< command
        double ends;     ///< when the move should have ended
    };
    move_cost(const parameters& p) : given_(p) {
        for (const double each : {p.tracking, p.after, p.effort})
            require(each > 0, "move_cost.tracking, after, effort", each, "must be above 0");
    }

    /// Hears a sample.
    void add(double time, double error, double command) {
        const auto over = [](double x, double unit) { return (x / unit) * (x / unit); };
        const bool late = !(time < given_.ends);
        (late ? later_ : during_) += over(error, late ? given_.after : given_.tracking);
        (late ? late_samples_ : samples_) += 1;
        pushed_ += over(command, given_.effort);
    }
    double value() const {
        const double all = samples_ + late_samples_;
        return (samples_ > 0 ? during_ / samples_ : 0) + (late_samples_ > 0 ? later_ / late_samples_ : 0) +
               (all > 0 ? pushed_ / all : HUGE_VAL);
    }

private:
    parameters given_;
    double during_ = 0, later_ = 0, pushed_ = 0, samples_ = 0, late_samples_ = 0;
};

} // namespace quadrant::inline v0::analysis
