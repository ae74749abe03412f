// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Effects that are no suspects of an axis.
struct exclusions {
    std::vector<std::string> by_owner;      ///< who may be wrong: they are weighed, never named
    std::vector<std::string> by_readings{}; ///< other readings show them, or that they are not there

    bool by_owner_alone(std::string_view effect) const {
        return holds(by_owner, effect) && !holds(by_readings, effect);
    }
    bool contains(std::string_view effect) const {
        return holds(by_owner, effect) || holds(by_readings, effect);
    }

private:
    static bool holds(const std::vector<std::string>& names, std::string_view effect) {
        return std::find(names.begin(), names.end(), effect) != names.end();
    }
};

} // namespace quadrant::inline v0::diagnosis
