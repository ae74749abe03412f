// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/decimal.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// One column of another program's log, in SI.
struct foreign_column {
    std::string name; ///< in our log
    std::size_t index;
    double factor;
    std::size_t element = 0; ///< of the list in its cells, from 1; 0: they hold a number
    std::vector<double> values{};
    written_step written{}; ///< before the factor

    /// The last digit of the column in SI; 0: none was rounded.
    double step() const { return written.step() * std::abs(factor); }
};

/// The rows of one file that a map wants: stamps from the first row of the first file, and columns.
struct foreign_table {
    std::vector<double> t; ///< as in the file [s]; increasing
    double written = 0;    ///< last digit of the stamps [s]
    std::vector<foreign_column> columns;
    std::vector<std::size_t> line; ///< of every row in the file, from 1
    std::vector<std::string> notes;
};

} // namespace quadrant::inline v0::diagnosis::detail
