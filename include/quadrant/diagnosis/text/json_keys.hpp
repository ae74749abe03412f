// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "axis_name.hpp"
#include "json_node.hpp"

#include <variant>

/// What the readers of JSON files share: schema, axes, unknown keys, and tables of numbers.
namespace quadrant::inline v0::diagnosis::detail {

using key_names = std::span<const std::string_view>;

inline void refuse_unknown_keys(const json_node& node, key_names numbers, key_names others = {}) {
    std::vector<std::string> known;
    for (const key_names& names : {numbers, others})
        for (std::string_view key : names) known.push_back(node.name(key));
    for (const auto& [key, value] : node.value->items()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        const json_node stranger = node.at(key, value);
        stranger.refuse("unknown key" + suggestion(key, known));
    }
}

inline void need_schema(const json_node& top, std::string_view name) {
    if (const auto given = top.object().need("schema"); given.text() != name)
        given.refuse(fmt::format("must be \"{}\"; this file is {}", name, in_quotes(given.text())));
}

/// Each of the axes that a machine file or a map must name: use(name, node).
template <class Use> void each_axis(const json_node& top, Use use) {
    const json_node axes = top.need("axes").object();
    if (axes.value->empty()) axes.refuse("must name at least one axis");
    for (const auto& [name, axis] : axes.value->items()) {
        if (!is_axis_name(name))
            axes.refuse(fmt::format("{}: an axis is named by letters, digits, _ and -", in_quotes(name)));
        use(name, axes.at(name, axis).object());
    }
}

/// One number of a file and the member that holds it; an optional one is absent where the file has no such key,
/// another one is 0 there.
template <class Target> struct number_key {
    const char* name;
    number_rule rule;
    std::variant<double Target::*, std::optional<double> Target::*> place;
    bool needed = false;

    void set(Target& target, double value) const {
        std::visit([&](auto member) { target.*member = value; }, place);
    }
    std::optional<double> get(const Target& target) const { // nothing: no key says the same
        const auto value =
            std::visit([&](auto member) -> std::optional<double> { return target.*member; }, place);
        const bool zero_if_absent = place.index() == 0 && !needed;
        return zero_if_absent && value == 0.0 ? std::nullopt : value;
    }
};

template <class Target, std::size_t N>
void read_numbers(const json_node& node, const std::array<number_key<Target>, N>& keys, key_names others,
                  Target& target) {
    refuse_unknown_keys(node.object(), names_of(keys), others);
    for (const auto& key : keys) {
        if (key.needed) node.need(key.name);
        if (const auto given = node.find(key.name)) key.set(target, given->number(key.rule));
    }
}

} // namespace quadrant::inline v0::diagnosis::detail
