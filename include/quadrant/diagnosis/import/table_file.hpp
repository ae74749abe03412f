// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../text/bad_input.hpp"

#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// A log as another program wrote it, as text: a MAT-file, a Parquet or HDF5 file as its table, a text in
/// UTF-8.
QUADRANT_DIAGNOSIS_DECL std::string text_of_table_file(std::string bytes, std::string_view file);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "table_file.ipp"
#endif
