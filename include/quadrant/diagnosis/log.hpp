// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "axis_words.hpp"

#include <string>
#include <vector>

namespace quadrant::diagnosis {

/// One axis of a servo log: one entry a sample, SI (a rotary axis: rad for m, N m for N).
struct axis_log {
    std::string name;
    bool still = false;             ///< neither reference nor position ever changes: a parked axis
    std::string command_unit = "V"; ///< "V", "A" or "N" ("Nm" of a rotary axis)
    std::vector<double> reference;  ///< position reference [m]
    std::vector<double> position;   ///< position as the controller read it [m]
    std::vector<double> command;    ///< controller output of that row, after limit and DAC
    std::vector<double> reference_velocity{}, reference_acceleration{}; ///< empty: differences of the reference
    std::vector<double> velocity{}; ///< as the controller read it [m/s]; empty: differences of the position
    std::vector<double>
        other_acceleration{};  ///< of the axis that may be coupled to this one [m/s^2]; empty: alone
    double reference_step = 0; ///< half of the last written digit bounds the rounding of the column; 0: exact
    double position_step = 0;  ///< the same for the position column
    double command_step = 0;   ///< the same for the command column
    axis_kind kind = axis_kind::linear;
};

/// A servo log (CSV, FORMAT.md). Sample k means t = k T.
struct machine_log {
    std::string file;
    double sample_period_s = 0; ///< mean of the stamps' differences
    std::size_t samples = 0;
    std::vector<axis_log> axes; ///< in the order of their names
    std::vector<std::string> notes;
};

} // namespace quadrant::diagnosis
