// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "number_table.hpp"
#include "thrift.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Four bytes, the small end first.
inline std::uint32_t parquet_word(std::string_view from, std::size_t at) {
    std::uint32_t out = 0;
    for (std::size_t k = 0; k < 4; ++k)
        out |= static_cast<std::uint32_t>(static_cast<unsigned char>(from[at + k])) << (8 * k);
    return out;
}

/// A column of a Parquet file: what its schema says of it, and what was read of it so far.
struct parquet_column {
    enum physical { boolean, int32, int64, int96, of_float, of_double, byte_array, fixed };
    static constexpr std::size_t most_bytes = std::size_t{1} << 28; ///< of a page

    std::string_view file; ///< for a refusal
    std::string name;
    int type = of_double;
    bool kept = false, optional = false, is_unsigned = false;
    double unit_s = 0; ///< of a time stamp [s]; 0: it is none
    std::vector<double> dictionary{}, values{};

    /// What the schema says; `nested`: inside a group.
    static parquet_column described(const thrift_struct& s, bool nested, std::string_view file) {
        constexpr std::int64_t repeated = 2, millis = 9, micros = 10, first_unsigned = 11, last_unsigned = 14;
        parquet_column c{.file = file, .name = column_name(s.text(4))};
        c.type = static_cast<int>(s.integer(1, fixed));
        c.optional = s.integer(3, 0) == 1;
        const auto converted = s.integer(6, -1);
        c.is_unsigned = converted >= first_unsigned && converted <= last_unsigned;
        const bool number = c.type <= int64 || c.type == of_float || c.type == of_double;
        const bool decimal = converted == 5 || s.inner(10, 5).has_value();
        c.kept = number && !decimal && !nested && s.integer(3, 0) != repeated &&
                 !c.name.starts_with("__index_level_"); // the row numbers of pandas
        if (converted == millis) c.unit_s = 1e-3;
        if (converted == micros) c.unit_s = 1e-6;
        if (const auto stamp =
                s.inner(10, 8)) { // LogicalType TIMESTAMP: its unit is one of three empty structs
            constexpr double units[] = {0, 1e-3, 1e-6, 1e-9};
            if (const auto unit = stamp->inner(2))
                for (int k = 1; k <= 3; ++k)
                    if (unit->has(k)) c.unit_s = units[k];
        }
        if (c.unit_s > 0 && !c.name.ends_with("_s")) c.name += "_s";
        return c;
    }

    [[noreturn]] void refuse(const std::string& why) const {
        throw bad_input(file, "column " + name + ": " + why);
    }
};

} // namespace quadrant::inline v0::diagnosis::detail
