// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect_list.hpp"

namespace quadrant::inline v0::diagnosis {

/// The numbers that a description has under a key of an effect; empty: it says nothing. A member that is no
/// optional says nothing while it is 0.
inline std::vector<double> numbers_of(const axis_description& axis, const machine_key& key, const effect& of) {
    if (key.at) {
        auto& place = const_cast<axis_description&>(axis); // `at` gives places to read and to write
        return std::visit(
            [&](const auto* p) -> std::vector<double> {
                if constexpr (requires { p->size(); })
                    return *p;
                else if constexpr (requires { p->has_value(); })
                    return p->has_value() ? std::vector<double>{**p} : std::vector<double>{};
                else
                    return *p != 0 || key.required ? std::vector<double>{*p} : std::vector<double>{};
            },
            key.at(place));
    }
    if (of.law) {
        const std::size_t i = of.law->index_of(key.name);
        for (const auto& l : axis.laws)
            if (l.law == of.law && i < of.law->count()) return {l.values[i]};
        return {};
    }
    const auto found = axis.numbers.find(key.name);
    return found == axis.numbers.end() ? std::vector<double>{} : found->second;
}

/// Puts the numbers of a key into a description; for an array one an entry, else one.
inline void put_numbers(axis_description& axis, const machine_key& key, const effect& of,
                        const std::vector<double>& values) {
    if (key.at) {
        std::visit(
            [&](auto* p) {
                if constexpr (requires { p->size(); })
                    *p = values;
                else
                    *p = values.at(0);
            },
            key.at(axis));
    } else if (of.law && of.law->index_of(key.name) < of.law->count()) {
        const auto is = [&](const auto& l) { return l.law == of.law; };
        auto found = std::find_if(axis.laws.begin(), axis.laws.end(), is);
        if (found == axis.laws.end()) found = axis.laws.insert(found, {of.law, {}});
        found->values[of.law->index_of(key.name)] = values.at(0);
    } else {
        axis.numbers[std::string(key.name)] = values;
    }
}

} // namespace quadrant::inline v0::diagnosis
