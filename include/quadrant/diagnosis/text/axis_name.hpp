// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// Names appear in messages, as JSON keys and in dotted paths.
inline bool is_axis_name(std::string_view name) {
    constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    return !name.empty() && name.find_first_not_of(allowed) == name.npos;
}

} // namespace quadrant::inline v0::diagnosis::detail
