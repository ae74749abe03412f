// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../machine/machine.hpp"
#include "../result/result.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>

namespace quadrant::inline v0::diagnosis::detail::beside {

/// What no machine file has a key for: it happened in one record.
QUADRANT_DIAGNOSIS_DECL bool is_of_record(const std::string& effect);
/// A process runs when its log is recorded; where in its cycle it begins is that log's own.
inline bool is_process(const std::string& effect) { return effect == "cutting_force"; }
/// What a replay of the controller or the steps of the reading show, whatever the model of the plant.
inline bool is_replayed(const std::string& effect) {
    return effect == "controller_mismatch" || effect == "added_command" || effect == "encoder_quantization";
}
inline bool is_claimed(const cause& c) { return std::max(c.probability, c.group_probability) >= 0.5; }

inline const cause* cause_in(const diagnosis_result& d, const std::string& axis, const std::string& effect) {
    for (const cause& c : d.causes)
        if (c.axis == axis && c.effect == effect) return &c;
    return nullptr;
}

/// The machine with what a diagnosis found: every cause that `keep` picks, claims and suspects. Values that
/// moved inside the owner's tolerance stay as described: either log may move them anew. Nothing where these
/// causes alone make no machine, as a static friction whose Coulomb level is another cause.
QUADRANT_DIAGNOSIS_DECL std::optional<machine_description>
with_some(const machine_description& machine, diagnosis_result d,
          const std::function<bool(const cause&)>& keep);
/// With all of them, or with the claims where the suspects make no machine, or as described.
QUADRANT_DIAGNOSIS_DECL machine_description with_causes(const machine_description& machine,
                                                        const diagnosis_result& d);

} // namespace quadrant::inline v0::diagnosis::detail::beside

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "with_causes.ipp"
#endif
