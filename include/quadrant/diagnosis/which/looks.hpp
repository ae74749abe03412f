// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "axis_case.hpp"
#include "stages.hpp"

#include <memory>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// An axis as it is looked at. All of it outlives the models.
struct looked_at {
    const axis_description& axis;
    const axis_log &log, ///< what is fitted first
        &apart;          ///< the log itself, where `log` is both motions together
    const axis_log* holdout;
    bool both; ///< log and hold-out log are fitted together
    bool soft; ///< evaluated on its path: the loop is so soft that a force moves it
    double period;
    const exclusions& excluded;
    const rules& limits;
    const stages& stage;
    /// What was found of these logs, corrected by their readings, with fewer names excluded; null: nothing.
    const axis_case* found = nullptr;
};

/// The models of an axis: fitted to the readings, then once more along the measured motion or to the hold-out
/// log where what was found asks for it. Why is told in `notes`. A log without one block of samples is a
/// bad_input.
QUADRANT_DIAGNOSIS_DECL std::unique_ptr<axis_case>
look_at(const looked_at& of, const std::string& file, const progress& tell, std::vector<std::string>& notes);

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "looks.ipp"
#endif
