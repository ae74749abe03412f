// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/axis_words.hpp"
#include "waveform.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// What a diagnosis says: the JSON of docs/formats.md (schema quadrant.diagnosis/1) plus the signals that the
/// report draws. Fields named in m and N are in rad and N m for a rotary axis; keys and sentences are in its
/// own words already.
namespace quadrant::inline v0::diagnosis {

/// Ordered from the best to the worst: the verdict of several axes is the largest.
enum class verdict { no_gap, within_tolerance, explained, partly_explained, unexplained };

/// The verdict's word in files and on pages.
constexpr const char* name_of(verdict v) {
    switch (v) {
    case verdict::no_gap:
        return "no_gap";
    case verdict::within_tolerance:
        return "within_tolerance";
    case verdict::explained:
        return "explained";
    case verdict::partly_explained:
        return "partly_explained";
    default:
        return "unexplained";
    }
}

/// A number and the interval that holds it with 95 %.
struct estimate {
    double value = 0, low = 0, high = 0; ///< 95 % interval
};

/// How far simulation and machine are apart on one axis: positions and command in closed loop, force along the
/// motion that was logged.
struct gap_numbers {
    double position_rms_m = 0, position_peak_m = 0; ///< closed-loop simulation against the log
    double command_rms_V = 0;                       ///< the same
    double force_rms_N = 0;             ///< residual force, zero-phase filtered to bandwidth_Hz on both sides
    double noise_floor_force_rms_N = 0; ///< what sensor and rounding alone leave in the residual force
    double bandwidth_Hz = 0;
    double noise_floor_position_rms_m = 0; ///< of two positions that are compared without any force; else 0
};

/// One place of the gap. Shares of one view sum to one with its remainder, never across views.
struct place {
    std::string view;  ///< block, velocity, reversal, position, time, frequency, acceleration
    std::string block; ///< of the block view: controller, actuator, mechanics, sensor, process
    std::string finding;
    estimate share;
    std::string basis; ///< of the block view: replay or causes
};

/// One value of the machine file, as the log has it.
struct parameter_estimate {
    std::string key;              ///< the machine file's key
    std::vector<estimate> values; ///< one, or one a harmonic
    bool on_bound = false; ///< the fit stopped where it was not allowed to go on: the value may lie beyond
};

/// Another name for the same signal on this record, with the parameters it would have; or, of the same name,
/// other parameters that explain the record as well.
struct reading {
    std::string effect;
    std::vector<parameter_estimate> parameters;
};

/// An effect that explains a part of the gap: how probable, with which numbers, and what is left of the gap
/// with it.
struct cause {
    std::string axis, effect;
    bool described = false; ///< the machine file has a value for it, another one than found; else it has none
    double probability = 0; ///< of this name
    double group_probability = 0; ///< of this name or one it is confusable with
    std::vector<std::string> confusable_with;
    std::vector<parameter_estimate>
        parameters; ///< of a claim: as fitted with the claims alone, which apply writes
    std::vector<parameter_estimate> with_suspects; ///< of a claim beside suspects: as fitted with all of them
    std::vector<reading> readings;                 ///< of the names it is confusable with
    std::optional<added_waveform> waveform{};      ///< of an added command
    estimate gap_before_force_rms_N, gap_after_force_rms_N;
    estimate gap_before_position_rms_m, gap_after_position_rms_m;
    estimate gap_before_command_rms_V, gap_after_command_rms_V;
    estimate shrink; ///< 1 - after/before in force, on samples not used for the fit
    std::string exciting_motion;
    std::string
        better_form; ///< of what a force that no list names predicts better as a function; empty: of nothing
    std::string better_excluded{}; ///< which effect that the machine file excludes explains more; empty: none
};
/// Said to be there, by its name or one that it is confusable with; else it is a suspect.
inline bool claimed(const cause& c) { return c.group_probability >= 0.5; }
/// Whether a number of it is that key of the machine file.
inline bool gives(const cause& c, std::string_view key) {
    return std::any_of(c.parameters.begin(), c.parameters.end(),
                       [&](const parameter_estimate& p) { return p.key == key; });
}

/// Signals for the pictures, one entry a sample (t, ...), or a bin (frequency, ...).
struct axis_signals {
    std::vector<double> t, reference, position, velocity, command;
    std::vector<double> simulated_position_before,
        simulated_position_after;                        ///< closed loop; empty without a controller
    std::vector<double> residual_before, residual_after; ///< force [N]
    std::vector<double> command_replayed;                ///< the described controller on the logged r and y
    std::vector<double>
        command_added; ///< the waveform that is added to the command; empty: none, or another log
    std::vector<double> frequency_Hz, spectrum_before, spectrum_after; ///< residual force [N/sqrt(Hz)]
};

/// The verdict on one axis: its gap before and after, where it lies, and what the owner's tolerance covers.
struct axis_result {
    std::string name;
    quadrant::diagnosis::verdict verdict = verdict::no_gap;
    gap_numbers gap, gap_after; ///< as described; with calibration and every cause added, suspects too
    std::vector<place> where;
    std::vector<parameter_estimate> calibrated; ///< what moved inside the owner's tolerance, as machine keys
    std::vector<parameter_estimate>
        calibrated_with_suspects; ///< the same beside all suspects; empty: there are none
    std::string evaluated_on;     ///< "held-out segments of LOG" or the hold-out file
    axis_signals signals;
    axis_kind kind = axis_kind::linear;
    std::string command_unit = "V"; ///< of the command gaps
    bool cut = false;               ///< the time was up before the search had ended (rules::until)
    /// Two positions are compared, and nothing is known of forces: the gap is that of the positions, and the
    /// residual signals are differences of them [m].
    bool positions_only = false;
    bool driven = false; ///< its drive closes loops of its own: a box between controller and actuator
};

/// The motion to record next. A log-score of `rules::margin` counts as distinguished.
struct experiment {
    std::string motion; ///< in words, with its numbers; "none: ..." when no motion distinguishes them
    std::vector<std::string> separates;
    double expected_gain =
        0; ///< log-score by which the motion would separate them, at least; 0: not simulated, or not at all
    double gain_of_log = 0; ///< by which the log that was diagnosed does
    std::string finding{};  ///< how the gain was found, or what is left if no motion separates them
    std::string axis{};
    double period_s = 0;             ///< of the reference below
    std::vector<double> reference{}; ///< of the axis, one entry a sample [m]; empty: no motion was simulated
};

/// What no log of an axis can show, and the instrument that sees it.
struct unseen {
    std::string axis, what, instrument;
};

/// The verdict on a machine: its axes, the causes by rank, what to record next, and what no log can show.
struct diagnosis_result {
    quadrant::diagnosis::verdict verdict = verdict::no_gap;
    std::vector<axis_result> axes;
    std::vector<cause> causes; ///< the first explains most
    double share_unexplained = 0;
    std::string remaining_structure;
    experiment next;
    std::vector<unseen> not_seen; ///< where it bears on what is said (blind_spots.hpp)
    std::vector<std::string> notes;
    std::vector<std::string> own_effects; ///< names beside the list that were suspects, too (own_effect.hpp)
    std::string machine_file, log_file, holdout_file;
    std::string machine_sha256, log_sha256, holdout_sha256; ///< of the files' bytes; empty: not read from files

    axis_kind kind_of(const std::string& axis) const {
        for (const axis_result& a : axes)
            if (a.name == axis) return a.kind;
        return axis_kind::linear;
    }
};

namespace detail {

/// The axis of this name, or null.
template <class Axes> auto named(const Axes& axes, const std::string& name) {
    const auto found = std::find_if(axes.begin(), axes.end(), [&](const auto& a) { return a.name == name; });
    return found == axes.end() ? nullptr : &*found;
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
