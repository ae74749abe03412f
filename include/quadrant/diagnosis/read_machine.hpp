// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "machine/machine.hpp"

#include <filesystem>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// Reads a machine file (docs/formats.md) or throws bad_input. Nothing in it is ignored but a controller of
/// unknown kind.
QUADRANT_DIAGNOSIS_DECL machine_description read_machine(std::string_view text, std::string_view name);
QUADRANT_DIAGNOSIS_DECL machine_description read_machine(const std::filesystem::path& path);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "read_machine.ipp"
#endif
