// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "run.hpp"

namespace quadrant::inline v0::diagnosis {

enum class circle_verdict {
    found,         ///< above its detection limit
    below_limit,   ///< not above it: `limit` says what would have been seen
    not_separable, ///< these runs cannot distinguish it from `together_with`, which carries what both are
    not_visible,   ///< to encoders: lies behind them
    not_tested     ///< the runs hold nothing that would show it
};
constexpr const char* name_of(circle_verdict v) {
    constexpr const char* names[] = {"found", "below_limit", "not_separable", "not_visible", "not_tested"};
    return names[static_cast<int>(v)];
}

/// A number with its 95 % interval.
struct circle_number {
    double value = 0, low = 0, high = 0;
};

/// What one group of runs (same feed and radius) shows of an error.
struct circle_detail {
    std::string what; ///< such as "x+, feed 0.1 m/s, radius 0.03 m"
    double feed = 0, radius = 0;
    circle_number size{}; ///< in the error's unit
    double width_s = 0;   ///< of a reversal spike at half height
};

/// One error of the machine, as a ball-bar names it.
struct circle_error {
    std::string name; ///< "squareness"
    std::string axis; ///< "x", "y" or empty: of the pair
    std::string unit; ///< SI, of value and limit
    std::string sign; ///< what a positive value means
    circle_verdict verdict = circle_verdict::below_limit;
    circle_number value{};
    double limit = 0;       ///< what would be found is at least so large; in the error's unit
    double circularity = 0; ///< circular error if this were the only one, largest of all runs [m]
    double share = 0;       ///< of the sum of all circularities
    std::vector<std::string> together_with; ///< what these runs cannot distinguish from it
    std::string needs;                      ///< which runs isolate it, or which instrument sees it
    std::string reading;                    ///< what these runs say of its cause
    std::vector<std::string> effects;       ///< names of the machine file that may be behind it
    std::vector<circle_detail> details;
    double period = 0; ///< of a cyclic error [m], of a vibration its frequency [Hz]
};

/// What one run measured, before any model.
struct circle_run_result {
    circle_run run;
    double circular_error = 0; ///< G of ISO 230-4: least distance of two concentric circles that hold the run
    double radial_max = 0, radial_min = 0; ///< about the nominal centre; of an instrument: about the fitted one
    double remaining = 0;                  ///< rms of what no error explains
    double centre_x = 0, centre_y = 0;     ///< of the fitted circle, from the nominal one
    std::vector<double> model;             ///< deviation that the found errors leave, sample by sample
};

/// What runs along circles say of two axes: every run by itself, and the errors that explain them together.
struct circle_result {
    circle_source source = circle_source::encoder;
    std::string first_axis = "x", second_axis = "y";
    std::vector<circle_run_result> runs;
    std::vector<circle_error> errors; ///< ranked: found ones by circularity, then the others
    double explained = 0; ///< share of the mean square of the deviation, centre and length taken out
    std::vector<std::string> notes;
};

} // namespace quadrant::inline v0::diagnosis
