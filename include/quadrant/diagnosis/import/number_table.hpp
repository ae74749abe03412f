// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/bad_input.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// A column of a file of numbers on its way to a table of text. NaN stands for no value.
struct number_column {
    std::string name;
    std::vector<double> values;
};

/// A name from a file of numbers as the head of a column: what would end the cell or the line is replaced.
inline std::string column_name(std::string_view name) {
    std::string out(name);
    for (char& c : out)
        if (c == ',' || c == '"' || static_cast<unsigned char>(c) < ' ') c = '_';
    return out;
}

/// A cell behind the last row of a column that is shorter than another of its file.
inline constexpr std::string_view past_the_end = "end";

/// What import_log reads: a line of names, then rows. No value is an empty cell. A file may hold columns of
/// several lengths; those of one log are of one length, which the reader of the table checks.
inline std::string text_of_table(const std::vector<number_column>& columns, std::string_view file) {
    constexpr std::size_t most_cells = std::size_t{1} << 25;
    std::string out;
    std::size_t rows = 0;
    for (const number_column& c : columns) {
        out += (out.empty() ? "" : ",") + c.name;
        rows = std::max(rows, c.values.size());
    }
    if (rows > most_cells / std::max<std::size_t>(1, columns.size()))
        throw bad_input(file, fmt::format("{} columns of up to {} rows: save only what belongs to one log, and "
                                          "no matrix that lies on its side",
                                          columns.size(), rows));
    out += '\n';
    for (std::size_t row = 0; row < rows; ++row) {
        const char* before = "";
        for (const number_column& c : columns) {
            if (row >= c.values.size())
                out.append(before).append(past_the_end);
            else if (std::isnan(c.values[row]))
                out += before;
            else
                fmt::format_to(std::back_inserter(out), "{}{}", before, c.values[row]);
            before = ",";
        }
        out += '\n';
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
