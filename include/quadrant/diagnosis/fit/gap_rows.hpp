// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Rows that are not judged: those of long gaps, and those in which the observer forgets the gap before.
struct gap_rows {
    std::vector<unsigned char> gap, settling;
};

/// The rows of gaps that last longer than the response of the observer. It follows what was filled into a
/// shorter one (a missing row, a wrong reading) without harm. Behind a longer one its state is unknown, as at
/// the start of a record, and as many rows go by before it is judged.
QUADRANT_DIAGNOSIS_DECL gap_rows long_gaps(std::span<const unsigned char> left_out, double response_rows,
                                           std::size_t skip);

/// First rows of the blocks of this length from `skip` on, one behind the other, around the rows that are not
/// judged.
QUADRANT_DIAGNOSIS_DECL std::vector<std::size_t>
lay_blocks(std::size_t block, std::size_t skip, const std::vector<unsigned char>& settling, std::size_t rows);

/// These rows and their neighbours: a second difference reaches over one row on each side.
QUADRANT_DIAGNOSIS_DECL std::vector<unsigned char> around(const std::vector<unsigned char>& rows);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "gap_rows.ipp"
#endif
