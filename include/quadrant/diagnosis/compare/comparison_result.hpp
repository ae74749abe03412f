// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "../result/result.hpp"

#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What a comparison of two logs says of an axis, from the best to the worst.
enum class likeness {
    alike,     ///< one model explains both, as far as their common rest shows
    undecided, ///< what the one shows, the motion of the other would not show
    differ,    ///< they differ by effects that are named
    unnamed    ///< they differ, and no effect is named
};

/// The word of a likeness in files and on pages.
constexpr const char* name_of(likeness l) {
    switch (l) {
    case likeness::alike:
        return "alike";
    case likeness::undecided:
        return "undecided";
    case likeness::differ:
        return "differ";
    default:
        return "unnamed";
    }
}

/// An effect by which two logs of an axis differ: the name, and what it is in either log.
struct difference {
    std::string axis, effect;
    double probability = 0; ///< of this effect, or one that it is confusable with
    std::vector<std::string> confusable_with;
    /// Values under the machine file's keys in the first and the second log; empty: the effect is not in it.
    std::vector<parameter_estimate> first, second;
    bool found_in_second = true; ///< the log that was explained by the model of the other; the gaps are its own
    estimate gap_before_force_rms_N, gap_after_force_rms_N;
    estimate gap_before_position_rms_m, gap_after_position_rms_m;
    /// Log-score by which the log in which it was found is better explained with it, and the other log worse.
    /// Zero where a replay of the controller or the steps of the reading distinguish the two.
    double gain = 0, loss = 0;
};

/// Two logs of one axis beside each other.
struct compared_axis {
    std::string name, command_unit = "V";
    axis_kind kind = axis_kind::linear;
    quadrant::diagnosis::likeness likeness = likeness::alike;
    bool found_in_second = true; ///< the second log was explained by the model of the first, or the other way
    /// Residual force of the log that was explained [N]: by the model of the other log, with the differences
    /// that are named, and by its own model; and of the other log by that log's model.
    double force_before_N = 0, force_after_N = 0, force_own_N = 0, force_common_N = 0;
    double floor_N = 0; ///< that noise and rounding alone leave
    /// What calibration says of the described values in either log, inside the owner's tolerance.
    std::vector<parameter_estimate> first, second;
};

/// What two logs of one machine, or of two that are described alike, say about each other.
struct comparison_result {
    quadrant::diagnosis::likeness likeness = likeness::alike; ///< the worst of the axes
    std::vector<compared_axis> axes;
    std::vector<difference> differences; ///< named, the first takes most off
    std::vector<difference> undecided;   ///< seen in one log; the motion of the other would not show them
    diagnosis_result first, second;      ///< each log against the machine file
    diagnosis_result across;             ///< one log against the machine file with what the other has
    bool found_in_second = true;         ///< which: the second log, or the first
    std::vector<std::string> notes;
    std::string machine_file, first_file, second_file;
    std::string machine_sha256, first_sha256,
        second_sha256; ///< of the files' bytes; empty: not read from files
};

} // namespace quadrant::inline v0::diagnosis
