// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../result/result.hpp"

#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Keys and sentences as the axis' own kind has them; intervals end at zero where the key does.
QUADRANT_DIAGNOSIS_DECL void put_in_words(axis_kind kind, std::vector<parameter_estimate>& parameters);
QUADRANT_DIAGNOSIS_DECL void put_in_words(axis_kind kind, std::vector<place>& places);
QUADRANT_DIAGNOSIS_DECL void put_in_words(axis_kind kind, std::vector<cause>& causes);

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "own_words.ipp"
#endif
