// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../text/bad_input.hpp"
#include "map.hpp"

#include <filesystem>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// Reads a map or throws bad_input.
QUADRANT_DIAGNOSIS_DECL import_map read_import_map(std::string_view text, std::string_view name);
QUADRANT_DIAGNOSIS_DECL import_map read_import_map(const std::filesystem::path& path);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "read_map.ipp"
#endif
