// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "machine_keys.hpp"

namespace quadrant::diagnosis::detail {

using key_names = std::span<const std::string_view>;

inline void refuse_unknown_keys(const json_node& node, key_names numbers, key_names others) {
    std::vector<std::string_view> known(numbers.begin(), numbers.end());
    known.insert(known.end(), others.begin(), others.end());
    for (const auto& [key, value] : node.value->items()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        const json_node stranger = node.at(key, value);
        stranger.refuse("unknown key" + suggestion(key, known));
    }
}

template <class Target, std::size_t N>
void read_numbers(const json_node& node, const std::array<number_key<Target>, N>& keys, key_names others,
                  Target& target) {
    refuse_unknown_keys(node.object(), names_of(keys), others);
    for (const auto& key : keys) {
        if (key.needed) node.need(key.name);
        if (const auto given = node.find(key.name)) key.of(target) = given->number(key.rule);
    }
}

} // namespace quadrant::diagnosis::detail
