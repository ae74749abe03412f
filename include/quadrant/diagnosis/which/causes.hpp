// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "as_described.hpp"
#include "between_rows.hpp"
#include "cause_values.hpp"
#include "doubt.hpp"
#include "interval.hpp"
#include "late_velocity.hpp"
#include "of_the_motion.hpp"
#include "rivals.hpp"
#include "shadow.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {
/// Causes that nothing has tested are suspects, as are those that a test contradicts.
QUADRANT_DIAGNOSIS_DECL void to_suspects(std::span<cause> causes);
} // namespace detail

/// The causes behind the command wire, in the order of the path, with probabilities, intervals and second
/// readings. `rivals`: of each, the models that it is weighed against (detail::rivals_of).
QUADRANT_DIAGNOSIS_DECL std::vector<cause> plant_causes(const axis_case& c,
                                                        const std::vector<std::vector<detail::rival>>& rivals);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "causes.ipp"
#endif
