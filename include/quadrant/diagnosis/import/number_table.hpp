// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/bad_input.hpp"

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

/// What import_log reads: a line of names, then rows. No value is an empty cell. Columns of one log are of one
/// length.
inline std::string text_of_table(const std::vector<number_column>& columns, std::string_view file) {
    std::string out;
    for (const number_column& c : columns) {
        if (c.values.size() != columns.front().values.size())
            throw bad_input(file,
                            fmt::format("{} has {} rows, {} has {}: save only what belongs to one log", c.name,
                                        c.values.size(), columns.front().name, columns.front().values.size()));
        out += (out.empty() ? "" : ",") + c.name;
    }
    out += '\n';
    for (std::size_t row = 0; row < columns.front().values.size(); ++row) {
        const char* before = "";
        for (const number_column& c : columns) {
            if (std::isnan(c.values[row]))
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
