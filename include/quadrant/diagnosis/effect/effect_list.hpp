// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "effect_record.hpp"

#include <fmt/format.h>

#include <span>

namespace quadrant::inline v0::diagnosis {

/// Every effect that a file may speak of, in the order of effects.hpp. The list costs no compile time here: it
/// is made with the rest of the diagnosis (base/version.hpp).
QUADRANT_DIAGNOSIS_DECL std::span<const effect* const> every_effect();

/// The effect of this name; null: none of the list.
inline const effect* effect_named(std::string_view name) {
    for (const effect* e : every_effect())
        if (e->name == name) return e;
    return nullptr;
}

/// As people call an effect; the name itself where the list does not have it.
inline std::string_view label_of_effect(std::string_view name) {
    const effect* e = effect_named(name);
    return e ? label_of(*e) : name;
}

/// The names of all effects, for messages.
inline std::vector<std::string_view> names_of_effects() {
    std::vector<std::string_view> out;
    for (const effect* e : every_effect()) out.push_back(e->name);
    return out;
}

/// Calls use(key, effect) for each key of the list that stands in this box of a machine file.
template <class Use> void for_each_key(std::string_view box, Use use) {
    for (const effect* e : every_effect())
        for (const machine_key& k : e->keys)
            if (k.box() == box) use(k, *e);
}

/// The key of this name, with its box as in machine_key::name, in the words of either kind of axis; null: no
/// effect has it.
inline const machine_key* key_named(std::string_view name) {
    for (const effect* e : every_effect())
        for (const machine_key& k : e->keys)
            if (k.name == name || k.name_for(axis_kind::rotary) == name) return &k;
    return nullptr;
}

/// A key that a record names without its box, as an axis of this kind has it.
inline std::string key_in_box(std::string_view box, std::string_view key, axis_kind kind) {
    const machine_key* known = key_named(box == "plant" ? std::string(key) : fmt::format("{}.{}", box, key));
    return known ? known->key_for(kind) : key_of(key, kind);
}

/// A law that a machine file can name: one of an effect of the list.
inline bool is_listed(const own_law* law) {
    for (const effect* e : every_effect())
        if (law && e->law == law) return true;
    return false;
}

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "effect_list.ipp"
#endif
