// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "../text/json_keys.hpp"

/// What a machine file says of two motors on one beam.
namespace quadrant::inline v0::diagnosis::detail {

inline constexpr std::array<std::string_view, 2> gantry_pair_keys{"ends", "share"};

inline gantry_description read_gantry_pair(const json_node& node) {
    refuse_unknown_keys(node.object(), gantry_pair_keys);
    const json_node ends = node.need("ends");
    if (!ends.value->is_array() || ends.value->size() != 2)
        ends.refuse("must be an array of two axes of the log");
    gantry_description out;
    for (std::size_t i = 0; i < 2; ++i) {
        const json_node end{&(*ends.value)[i], fmt::format("{}[{}]", ends.path, i), ends.file};
        (i == 0 ? out.first : out.second) = end.text();
        if (!is_axis_name(end.text())) end.refuse("an axis is named by letters, digits, _ and -");
    }
    if (out.first == out.second) ends.refuse("must be two axes");
    if (const auto share = node.find("share")) {
        out.share = share->number(rule::positive);
        if (!(out.share < 1)) share->refuse("must lie between 0 and 1");
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
