// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "effect/rules.hpp"
#include "log/log.hpp"
#include "machine/machine.hpp"
#include "result/result.hpp"

namespace quadrant::inline v0::diagnosis {

/// From a machine file and a log to where they differ, why, how surely, and how far the gap shrinks with each
/// cause. Deterministic. Machine and log match (match.hpp). A log is refused (bad_input) only where not one
/// block of its samples can be scored; one that holds a single motion is cut into pieces, with a note
/// (pieces.hpp). Cost: linear in rows; each suspect costs a few dozen passes of the plant over the log. A
/// controller of your own (own_controller.hpp) and effects of your own (own_effect.hpp) stand in the machine;
/// what is wrong with them is an std::invalid_argument.
QUADRANT_DIAGNOSIS_DECL diagnosis_result diagnose(const machine_description& machine, const machine_log& log,
                                                  const machine_log* holdout = nullptr,
                                                  const progress& tell = {}, const rules& r = {});

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "diagnose.ipp"
#endif
