// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../fit/record.hpp"
#include "added/candidate.hpp"
#include "controller_box.hpp"
#include "searched_keys.hpp"

namespace quadrant::inline v0::diagnosis {

/// The controller box checked by replay: deterministic, so whatever is above rounding is a controller that is
/// not the one described. Which key differs is found by fitting one at a time, on this box alone.
struct controller_finding {
    std::vector<double> replayed; ///< the described controller on the logged r and y
    double difference_rms = 0;    ///< against the logged command
    double floor_rms = 0;         ///< what rounding of columns and command alone makes of it
    bool differs = false;
    std::string key; ///< that corrects it best; empty: none does
    double described = 0, value = 0, low = 0, high = 0;
    double after_rms = 0; ///< with the key corrected
    bool mended = false;  ///< the corrected controller agrees to rounding
    /// Another key that brings the replay back to rounding as well: the log cannot distinguish the two.
    struct alternative {
        std::string key;
        double value = 0;
    };
    std::vector<alternative> alternatives; ///< of `key`, where that corrects it
    std::optional<added_finding> added{};  ///< what is added to the command, where no key corrects it
    /// The controller is the described one but for its integral behind a time at its own limit; when that is
    /// reached first [s].
    std::optional<double> limits_otherwise_from{};
    /// A signal is added to the command, and that is more probable than not.
    bool is_added() const { return added && added->probability >= 0.5; }
};

/// Replays a controller on a log, and finds what differs. `count`: of the encoder that the position was read
/// from, where it is known [m].
QUADRANT_DIAGNOSIS_DECL controller_finding judge_controller(const controller_description& described,
                                                            const actuator_description& actuator,
                                                            const axis_log& log, const axis_record& record,
                                                            double count = 0);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "controller_mismatch.ipp"
#endif
