// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/text.hpp"
#include "hdf5_file.hpp"
#include "mat_file.hpp"
#include "parquet_file.hpp"

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::string text_of_table_file(std::string bytes, std::string_view file) {
    if (is_hdf5_file(bytes)) return table_of_hdf5_file(bytes, file); // MAT-files of level 7.3, too
    if (is_mat_file(bytes)) return table_of_mat_file(bytes, file);
    if (is_parquet_file(bytes)) return table_of_parquet_file(bytes, file);
    return detail::in_utf8(std::move(bytes));
}

} // namespace quadrant::inline v0::diagnosis
