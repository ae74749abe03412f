// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../result/result.hpp"
#include "../text/key_value.hpp"
#include "compensator.hpp"
#include "drive_addition.hpp"

namespace quadrant::inline v0::diagnosis {

/// How well an axis follows its reference on one log, and with what command.
struct tracking {
    estimate rms_m, peak_m;
    estimate glitch_m; ///< mean of the largest errors within 0.1 s after each reversal; 0: no reversal
    estimate command_rms_V;
};

/// A feedforward in the controller that is built from fitted causes, and what it is forecast to do.
struct compensation {
    std::string name;
    std::vector<std::string> effects{}; ///< of the causes that it is built from
    std::string block{}; ///< of the library; empty: keys that the machine file's controller has say it all
    std::vector<key_value> settings{}; ///< of the block, in the unit of the command
    std::vector<key_value> keys{};     ///< of the machine file's controller, and their new values
    compensated_forces forces{};       ///< that a `compensator` pays beside the keys
    drive_addition drive{};            ///< what a drive with loops of its own is told beside its command
    tracking after{};                  ///< forecast, over plants drawn from the intervals of the diagnosis
    estimate gain{};                   ///< share of the rms that it takes off
    double gain_at_ends = 0;           ///< the least, every fitted value at one end of its interval
    bool claimed = false;              ///< the gain stands above the noise of the reading in every draw

    /// Keys of the machine file's controller are all of it.
    bool by_keys() const { return forces == compensated_forces{} && !of_drive(); }
    bool of_drive() const { return drive.set_point.any() || drive.force.any(); }
};

/// What to do about a cause that no feedforward corrects.
struct advice {
    std::string effect, text;
};

/// One axis: how it follows now, and what each compensation would do.
struct compensated_axis {
    std::string name, command_unit;
    axis_kind kind = axis_kind::linear;      ///< of a rotary axis every m below is rad
    bool forecast = false;                   ///< a controller is described, so that there is a loop to simulate
    bool positions_only = false;             ///< forecast on the readings of two positions, without a loop
    tracking measured;                       ///< on the log as it is
    double missed_rms_m = 0;                 ///< simulated beside logged position, nothing compensated
    double noise_m = 0;                      ///< of the position reading
    std::vector<compensation> compensations; ///< one by one, then together
    std::vector<advice> others;              ///< causes without a feedforward

    /// Of those that are claimed the one that leaves least; nullptr: none.
    const compensation* best() const {
        const compensation* out = nullptr;
        for (const compensation& c : compensations)
            if (c.claimed && (!out || c.after.rms_m.value < out->after.rms_m.value)) out = &c;
        return out;
    }
};

/// What compensations would gain, axis by axis.
struct compensation_result {
    std::string machine_file, log_file;
    std::vector<compensated_axis> axes;
    std::vector<std::string> notes;
};

} // namespace quadrant::inline v0::diagnosis
