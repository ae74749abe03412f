// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "log/log.hpp"
#include "machine/machine.hpp"
#include "result/result.hpp"

#include <nlohmann/json.hpp>

namespace quadrant::inline v0::diagnosis {

/// The gap of one axis on a motion that was not recorded yet.
struct forecast_axis {
    std::string name;
    gap_numbers before; ///< the machine file as diagnosed, beside the machine that the diagnosis expects
    gap_numbers after;  ///< the corrected machine file beside the same
    double shrink = 0;  ///< 1 - after/before in force
    axis_kind kind = axis_kind::linear;
};

/// The gap to expect of every axis on a motion that was not recorded yet.
struct forecast_result {
    std::string machine_file, motion_file;
    std::vector<forecast_axis> axes;
    std::vector<std::string> notes;
};

/// How far the gap will shrink on another motion, known by its reference only: the corrected machine
/// (apply.hpp) runs it in closed loop, with sensor noise, and both machine files are compared with that record
/// as `simulate` compares them with a real one. What the diagnosis left unexplained on its own log is added to
/// both. An axis without a controller in the machine file is left out, with a note,
/// unless its drive takes positions. A drive's loops are closed inside the plant, its readings rounded to
/// counts. Costs a few passes over the motion.
QUADRANT_DIAGNOSIS_DECL forecast_result forecast(const machine_description& machine,
                                                 const diagnosis_result& found, const machine_log& motion,
                                                 double at_least = 0.5);

/// What is forecast, as JSON (docs/schema/forecast.schema.json).
QUADRANT_DIAGNOSIS_DECL nlohmann::ordered_json to_json(const forecast_result& f);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "forecast.ipp"
#endif
