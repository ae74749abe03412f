// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// A key of the machine file and its numbers.
struct key_value {
    std::string key;
    std::vector<double> values; ///< one, or one a harmonic
};

} // namespace quadrant::inline v0::diagnosis
