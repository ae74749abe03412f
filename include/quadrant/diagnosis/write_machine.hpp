// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "machine/machine.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

namespace detail {
/// The keys of a box as an axis of this kind has them.
QUADRANT_DIAGNOSIS_DECL nlohmann::ordered_json in_words_of(axis_kind kind, std::string_view box,
                                                           const nlohmann::ordered_json& content);
} // namespace detail

/// The machine file (docs/formats.md) of a description: read_machine() of it gives the description back, but
/// for a controller
/// of unknown kind, of which a description holds nothing, and for what is code: controllers, effects and forces
/// of your own.
QUADRANT_DIAGNOSIS_DECL nlohmann::ordered_json to_json(const machine_description& m);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "write_machine.ipp"
#endif
