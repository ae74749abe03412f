// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "row.hpp"

/// All experiments; a new one is a file in experiment/ and a line in one of these, which are compiled beside
/// each other.
namespace quadrant_reproduce {

std::vector<experiment> loop_experiments();
std::vector<experiment> friction_experiments();
std::vector<experiment> milling_experiments();
std::vector<experiment> other_machine_experiments();
std::vector<experiment> vcnc_experiments();
std::vector<experiment> stage_experiments();

/// In the order of the page.
inline std::vector<experiment> experiments() {
    std::vector<experiment> all = loop_experiments();
    for (const auto& part : {friction_experiments(), milling_experiments(), other_machine_experiments(),
                             vcnc_experiments(), stage_experiments()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace quadrant_reproduce
