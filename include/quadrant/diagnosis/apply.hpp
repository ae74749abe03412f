// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "machine/machine.hpp"
#include "result/result.hpp"

#include <nlohmann/json.hpp>

namespace quadrant::inline v0::diagnosis {

/// One value of a machine file that a diagnosis changes, as JSON text.
struct applied_change {
    std::string path, before, after; ///< before: empty where the key was absent
    std::string reason;              ///< the effect, or what moves with it
};

/// A machine file with the causes of a diagnosis in it, and what was changed.
struct applied_diagnosis {
    nlohmann::ordered_json machine; ///< key order and every other value of the original kept
    std::vector<applied_change> changes;
    std::vector<std::string> notes; ///< causes that were left out, and why
};

/// Writes the causes of a diagnosis that are at least as probable as `at_least` into a machine file: its JSON
/// text in, the corrected document and what was changed out. Throws bad_input when the text is no machine file
/// (read_machine), when the diagnosis is of another machine, and when the values found are not ones that a
/// machine file may hold.
QUADRANT_DIAGNOSIS_DECL applied_diagnosis apply(std::string_view machine_text, std::string_view machine_file,
                                                const diagnosis_result& d, double at_least = 0.5);

/// The same on a description that was read or made before, with its code: the numbers of a controller of your
/// own are corrected, and an effect of your own becomes a law of the axis. A controller of unknown kind is not
/// in it, and so not in the result.
QUADRANT_DIAGNOSIS_DECL machine_description apply(const machine_description& machine, diagnosis_result d,
                                                  double at_least = 0.5);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "apply.ipp"
#endif
