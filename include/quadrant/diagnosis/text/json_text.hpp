// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "text.hpp"

#include <nlohmann/json.hpp>

namespace quadrant::inline v0::diagnosis::detail {

/// Parses JSON (RFC 8259) or throws bad_input.
QUADRANT_DIAGNOSIS_DECL nlohmann::json parse_json(std::string_view text, std::string_view file);

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "json_text.ipp"
#endif
