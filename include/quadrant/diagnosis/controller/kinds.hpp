// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "kind.hpp"

namespace quadrant::inline v0::diagnosis {

/// Every kind of controller that a machine file may name.
QUADRANT_DIAGNOSIS_DECL std::span<const controller_kind* const> controller_kinds();

/// The record of a kind, or null.
inline const controller_kind* find_controller_kind(std::string_view name) {
    for (const controller_kind* kind : controller_kinds())
        if (kind->name == name) return kind;
    return nullptr;
}
/// The record of a description's kind; throws std::invalid_argument for a kind, or a key of it, that is not
/// known.
inline const controller_kind& kind_of(const controller_description& c) {
    const controller_kind* kind = find_controller_kind(c.kind);
    if (!kind) throw std::invalid_argument(fmt::format("controller kind \"{}\" is not known", c.kind));
    for (const auto& [key, values] : c.values) kind->key(key);
    return *kind;
}

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "kinds.ipp"
#endif
