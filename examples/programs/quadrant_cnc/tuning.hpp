// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <quadrant/analysis/fuzzy_tuning.hpp>
#include <quadrant/block/axis_motion.hpp>

#include <string>
#include <vector>

/// Fuzzy tuning of the sliding mode law of one axis, on the machine of the file.
namespace quadrant_cnc {

/// The stroke of a trial, forth and back, and how its command is judged.
struct trial_stroke {
    double length_m = 0.1, feed_m_per_s = 0.2;
    double threshold_Hz = 50; ///< of the oscillation index
    int most_trials = 50;
};

/// One run of the stroke with one seed of the noise.
struct stroke_record {
    std::vector<double> error_m, command_V; ///< reference minus table, and command, sample by sample
};

struct axis_tuning {
    std::string name;
    double period = 0;
    trial_stroke stroke{};
    quadrant::analysis::tuning_result<> trials{};
    stroke_record before{}, after{}; ///< with the first and with the last gains

    const quadrant::analysis::tuning_step<>& start() const { return trials.steps.front(); }
    const quadrant::analysis::tuning_step<>& end() const { return trials.steps.back(); }
};

/// Tries the stroke on the axis as `run` would drive it (friction, play, noise, limits), with the gains of the
/// file first, until no rule asks for a change. Throws bad_input for another law than sliding_mode, and for a
/// stroke that the axis cannot make.
axis_tuning tune_axis(const cnc_description& cnc, const axis_description& a, const trial_stroke& stroke);

} // namespace quadrant_cnc
