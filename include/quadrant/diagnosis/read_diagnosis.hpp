// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "result/result.hpp"

#include <filesystem>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// Reads a diagnosis file (docs/formats.md) back or throws bad_input. The signals that the report draws are not
/// in it.
QUADRANT_DIAGNOSIS_DECL diagnosis_result read_diagnosis(std::string_view text, std::string_view name);
QUADRANT_DIAGNOSIS_DECL diagnosis_result read_diagnosis(const std::filesystem::path& path);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "read_diagnosis.ipp"
#endif
