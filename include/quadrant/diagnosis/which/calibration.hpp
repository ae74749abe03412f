// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../effect/described_numbers.hpp"
#include "../effect/effect.hpp"

namespace quadrant::inline v0::diagnosis {

/// The force that the velocity loop inside a drive holds at the first row: no file can know it. `most`: of the
/// record [N].
inline parameter start_of_drive(double most) {
    return {.key = "start_force",
            .of = [](plant_model& p) -> double& { return p.drive.start_force; },
            .start = 0,
            .low = -most,
            .high = most,
            .step = 1e-3 * most,
            .expected = 0,
            .spread = most};
}

/// When the position and what was measured behind the drive were read within a row, each up to a row off, where
/// registers are read one after the other, before or after the drive takes the row's set-point. They begin
/// where the drive that is given has them. None of a drive that takes all readings at once: a moment of its own
/// would be told from no delay of the set-points.
QUADRANT_DIAGNOSIS_DECL std::vector<parameter> timing_of_readings(const drive_model& d, double period);
/// Both of this record: what a search frees beside the machine's own numbers.
QUADRANT_DIAGNOSIS_DECL std::vector<parameter> numbers_of_record(const plant_model& described,
                                                                 const axis_record& record);
/// Whether a fitted number belongs to the record, not to the machine.
inline bool is_of_record(const parameter& p) {
    return p.key == "start_force" || p.key == "reading_age" || p.key == "tap_lateness";
}

/// The described machine's own numbers, free inside the owner's tolerance in every model: else a candidate is
/// credited with correcting the calibration. Hard bounds at the tolerance, and a weak pull to the given value,
/// which also settles what no log can identify: all forces, the mass and the force constant times one factor
/// move the axis alike. `give`: of every contact, record_scales::give(). `in_current`: what a velocity loop
/// inside the drive gives was measured as a current. Then the log shows its force gains and its limit over the
/// force constant only, and they lie in one box of tolerances with it.
QUADRANT_DIAGNOSIS_DECL std::vector<parameter> calibration(const axis_description& axis, double give,
                                                           bool in_current = false);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "calibration.ipp"
#endif
