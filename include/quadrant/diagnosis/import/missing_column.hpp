// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/bad_input.hpp"
#include "../text/json_node.hpp"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Names of columns for a message, the first twelve of them.
inline std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t most = 12;
    std::string out;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i) out += (i ? ", " : "") + one_line(names[i]);
    return out + (names.size() > most ? ", ..." : "");
}

/// What may be meant by the name of a column that is not there: another separator, a name that is near, or one
/// of those that are there.
inline std::string instead_of(const std::string& name, const std::vector<std::string>& names) {
    if (names.size() == 1)
        for (const auto& [sign, known] : {std::pair{'\t', "tab"}, std::pair{';', ";"}, std::pair{',', ","}})
            if (names[0].find(sign) != std::string::npos)
                return fmt::format(": the header is one column; is the separator \"{}\"?", known);
    if (std::string near = suggestion(name, names); !near.empty()) return near;
    return "; there are " + some_of(names);
}

} // namespace quadrant::inline v0::diagnosis::detail
