// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "import/import_choice.hpp"
#include "import/map.hpp"
#include "log/log.hpp"
#include "text/bad_input.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Another program's log in the words of ours.
struct imported_log {
    machine_log log;                ///< in SI: metres or radians; what read_log makes of the text
    std::string text;               ///< as docs/formats.md writes a log
    std::vector<std::string> notes; ///< what was assumed, and what physics says of it
};

/// Reads other programs' files through a map and joins them on time: columns renamed, numbers in SI. Rows stay
/// as they are, or are resampled onto an even clock. Rows may be missing; a number that is none, a column that
/// is not there, a stamp that goes back: bad_input with file, line and column.
QUADRANT_DIAGNOSIS_DECL imported_log import_log(const import_map& map, std::span<const foreign_file> files,
                                                const import_choice& choice = {});
QUADRANT_DIAGNOSIS_DECL imported_log import_log(const import_map& map, std::string_view text,
                                                std::string_view name, const import_choice& choice = {});
QUADRANT_DIAGNOSIS_DECL imported_log import_log(const import_map& map, const std::filesystem::path& path,
                                                const import_choice& choice = {});

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "import_log.ipp"
#endif
