// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "command_noise.hpp"
#include "regression.hpp"

#include <optional>

namespace quadrant::inline v0::diagnosis {

/// When a log's command acts, by a regression on the motion.
struct command_timing {
    double later =
        0; ///< its column stands later than the described plant's delay lets it act [s]; negative: earlier
    double acts_after = 0;    ///< from its row to its action; negative: it acts before it was recorded [s]
    double spread = 0;        ///< standard deviation of both [s]
    bool of_plant = false;    ///< the regression is of what the command does, not of a loop that answers
    bool outweighs = false;   ///< the shift takes off more than forces that no regression knows leave
    bool within_rows = false; ///< the motion is too fast for a loop that answers once a row
    bool sure() const { return of_plant && outweighs && std::abs(later) > 4 * spread; }
    /// Whether a measured command rather goes to its next row in a line, `half` a row later, than that it is
    /// held.
    bool goes_in_a_line(double half) const { return of_plant && within_rows && later > half / 2; }
};
QUADRANT_DIAGNOSIS_DECL command_timing timing_of_command(const axis_log& log, double period,
                                                         const plant_description& plant);

/// By how much the command's column stands later than the described plant's delay lets it act [s], negative:
/// earlier; 0: not surely. What acts comes before what it does, so a column that fits the motion better if it
/// is read earlier was recorded late: filtered, sent one cycle after the position, or taken once in a row
/// during which a faster loop went on. An asked command that acts late is another matter, `time_delay`, and no
/// lateness; a measured one acts at once, and what is late then is the reading of the position. Where the
/// motion is faster than a loop that answers once a row could make it, a measured command was not held in
/// between: unless its time is sure, it goes to its next row in a line, half a row later, where the motion has
/// that nearer. Effects that no regression knows move the answer by no more than half a row on the machines of
/// tests/diagnosis/late_command.cpp.
QUADRANT_DIAGNOSIS_DECL double lateness_of_command(const axis_log& log, double period,
                                                   const plant_description& plant, command_origin command);

/// A log with its command read earlier.
QUADRANT_DIAGNOSIS_DECL axis_log read_earlier(axis_log log, double seconds, double period);

/// What undoes a first-order low-pass, the factors c1 and c2 of u = y + c1 y' + c2 y''. Behind one of time
/// constant tau that runs all the time, read at the row of period T, c1 = tau + T/2 and c2 = tau T/2. Behind
/// one that runs once a row, c1 = tau and c2 = -tau T/2.
struct low_pass_undone {
    double of_slope = 0;     ///< c1 [s]
    double of_curvature = 0; ///< c2 [s2]
};

/// The low-pass behind which a measured command was recorded, as drives write their current; none: it is late,
/// if at all, without one. One that is late by d has c1 = d and c2 = d^2 / 2; a delay beside a low-pass counts
/// as one where the low-pass is most of it. What is late alone must leave more.
QUADRANT_DIAGNOSIS_DECL std::optional<low_pass_undone> low_pass_of_command(const axis_log& log, double period,
                                                                           const plant_description& plant);

/// A log with its command as it was before a low-pass; beside missing rows it stays as it is.
QUADRANT_DIAGNOSIS_DECL axis_log read_before_low_pass(axis_log log, const low_pass_undone& by, double period);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "late_command.ipp"
#endif
