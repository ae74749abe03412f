// SPDX-License-Identifier: BSL-1.0
// Long: one file format, read without its library: the structures of its specification one after the other.
#pragma once
#include "../text/bad_input.hpp"
#include "inflated.hpp"
#include "number_table.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// A MATLAB MAT-file of level 5 (save -v6, or -v7: compressed) on its way to a table of text. What is wrong
/// with it is said with its byte: of the file, or of what a compressed variable holds.
class mat_reader {
public:
    mat_reader(std::string_view bytes, std::string_view file)
        : file_(file), file_bytes_(bytes), bytes_(bytes) {}

    /// A MAT-file of level 5, or one of level 7.3, which take() refuses.
    static bool is_one(std::string_view bytes) {
        return bytes.size() >= header && bytes.starts_with("MATLAB ") &&
               (bytes.substr(126, 2) == "IM" || bytes.substr(126, 2) == "MI");
    }

    std::string take() {
        if (file_bytes_.starts_with("MATLAB 7.3"))
            refuse(0, "is of level 7.3 (HDF5): save it in MATLAB with save(..., '-v7'), or as CSV");
        swapped_ = (file_bytes_.substr(126, 2) == "MI") == (std::endian::native == std::endian::little);
        const auto version = integer<std::uint16_t>(124);
        if (version != 0x0100)
            refuse(124, fmt::format("version {:#06x} is not that of level 5 (0x0100)", version));
        for (at_ = header; at_ < bytes_.size();) {
            const element e = next();
            if (e.type == compressed)
                inflate(e);
            else if (e.type == matrix)
                read_variable(e);
        }
        return table();
    }

private:
    static constexpr std::size_t header = 128;
    static constexpr std::uint32_t compressed = 15, matrix = 14;
    static constexpr std::size_t most_inflated = std::size_t{1} << 28; ///< 33 million numbers

    struct element {
        std::uint32_t type;
        std::size_t at, size; ///< of its data
    };
    struct variable {
        std::string name;
        std::uint64_t rows, columns;
        std::vector<double> values; ///< column by column
    };

    [[noreturn]] void refuse(std::size_t at, std::string_view message) const {
        if (inside_ == 0) throw bad_input(file_, fmt::format("byte {}: {}", at, message));
        throw bad_input(file_,
                        fmt::format("byte {} (compressed; byte {} of its contents): {}", inside_, at, message));
    }

    template <class T> T integer(std::size_t at) const {
        T value{};
        if (bytes_.size() < sizeof(T) || at > bytes_.size() - sizeof(T))
            refuse(bytes_.size(), "ends in the middle of a variable");
        char raw[sizeof(T)];
        std::memcpy(raw, bytes_.data() + at, sizeof(T));
        if (swapped_) std::reverse(raw, raw + sizeof(T));
        std::memcpy(&value, raw, sizeof(T));
        return value;
    }

    /// The element at at_, which then stands behind it.
    element next() {
        const auto word = integer<std::uint32_t>(at_);
        const std::size_t tag = at_;
        element e{};
        if (word >> 16 != 0) { // a small one: type and size in one word, the data in the next
            e = {word & 0xffff, tag + 4, word >> 16};
            if (e.size > 4) refuse(tag, fmt::format("a small element of {} bytes; 4 are the most", e.size));
            at_ = tag + 8;
        } else {
            e = {word, tag + 8, integer<std::uint32_t>(tag + 4)};
            const std::size_t padded = e.type == compressed ? e.size : (e.size + 7) / 8 * 8;
            at_ = e.at + padded;
        }
        if (e.size > bytes_.size() - std::min(e.at, bytes_.size()))
            refuse(tag, fmt::format("an element of {} bytes; the file has {} behind this", e.size,
                                    bytes_.size() - std::min(e.at, bytes_.size())));
        if (e.type == 0 || e.type > 18) refuse(tag, fmt::format("{} is no type of an element", e.type));
        return e;
    }

    /// A variable that was saved compressed: zlib around one element.
    void inflate(const element& e) {
        const std::string_view packed = file_bytes_.substr(e.at, e.size);
        const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(packed[k]); };
        constexpr std::size_t around = 6; // two bytes before, a sum of four behind
        if (packed.size() < around || (byte(0) & 0x0f) != 8 || (byte(0) * 256 + byte(1)) % 31 != 0 ||
            byte(1) & 0x20)
            refuse(e.at, "no zlib stream begins here");
        const inflation out =
            inflated(packed.substr(2), most_inflated - inflated_); // the sum as well: the decoder looks ahead
        if (out.beyond)
            refuse(e.at, fmt::format("its compressed variables hold more than {} MiB", most_inflated >> 20));
        const std::string& contents = out.text;
        inflated_ += contents.size();
        if (!out.whole) refuse(e.at + 2 + out.read, "the zlib stream is broken");
        std::uint32_t sum = 0;
        for (std::size_t k = packed.size() - 4; k < packed.size(); ++k) sum = sum << 8 | byte(k);
        if (sum != adler32(contents))
            refuse(e.at + e.size - 4, "the checksum of the zlib stream does not match: the file is damaged");
        const std::size_t behind = at_;
        bytes_ = contents;
        inside_ = e.at - 8;
        at_ = 0;
        const element held = next();
        if (held.type == matrix) read_variable(held);
        bytes_ = file_bytes_;
        inside_ = 0;
        at_ = behind;
    }
    static std::uint32_t adler32(std::string_view bytes) {
        std::uint32_t a = 1, b = 0;
        for (const char c : bytes) {
            a = (a + static_cast<unsigned char>(c)) % 65521;
            b = (b + a) % 65521;
        }
        return b << 16 | a;
    }

    /// A variable of real numbers, or what a structure or a cell holds of them, under the name of its place;
    /// not texts and objects, nor a single number.
    void read_variable(const element& whole, std::string_view place = {}, int depth = 0) {
        const std::size_t behind = at_;
        at_ = whole.at;
        const element flags = next();
        if (flags.type != 6 || flags.size != 8) refuse(whole.at, "a variable begins with its flags (8 bytes)");
        const auto word = integer<std::uint32_t>(flags.at);
        const std::uint32_t kind = word & 0xff;
        constexpr std::uint32_t cells = 1, structure = 2, of_doubles = 6, last = 15, opaque = 17;
        if (kind == opaque) return void(at_ = behind); // an object of a class has no dimensions
        const element dimensions = next();
        if (dimensions.type != 5 || dimensions.size < 8 || dimensions.size % 4 != 0)
            refuse(dimensions.at, "the dimensions of a variable are 32-bit integers, two or more");
        const element name = next();
        variable v{.name = place.empty() ? text_at(name.at, name.size) : std::string(place),
                   .rows = 1,
                   .columns = 1,
                   .values = {}};
        const bool of_numbers = kind >= of_doubles && kind <= last;
        const bool of_parts = kind == cells || kind == structure;
        if (of_numbers || of_parts)
            for (std::size_t k = 0; k < dimensions.size / 4; ++k) {
                const auto n = integer<std::int32_t>(dimensions.at + 4 * k);
                if (n < 0)
                    refuse(dimensions.at + 4 * k, fmt::format("{}: dimension {} is negative", v.name, n));
                (k == 0 ? v.rows : v.columns) *= static_cast<std::uint64_t>(n);
                if (v.rows > bytes_.size() || v.columns > bytes_.size() ||
                    (v.columns > 0 && v.rows > bytes_.size() / v.columns))
                    refuse(dimensions.at, fmt::format("{}: has more numbers than the file has bytes", v.name));
            }
        if (of_parts) read_parts(v, whole, kind == structure, depth);
        if (of_numbers) {
            if (word & 0x0800)
                refuse(whole.at, fmt::format("{}: is complex: save its real and imaginary part apart", v.name));
            read_numbers(v);
        }
        if (at_ > behind) refuse(whole.at, fmt::format("{}: holds more data than its size allows", v.name));
        at_ = behind;
        if (v.values.size() > 1) variables_.push_back(std::move(v));
    }

    /// Text up to its end mark, as the head of a column.
    std::string text_at(std::size_t at, std::size_t size) const {
        const std::string_view text = bytes_.substr(at, size);
        return column_name(text.substr(0, text.find('\0')));
    }

    /// The fields of a structure, name.field, or the contents of a cell; of several name_1.field, name_2.field.
    void read_parts(const variable& v, const element& whole, bool is_structure, int depth) {
        constexpr int deepest = 16;
        if (depth == deepest)
            refuse(whole.at, fmt::format("{}: more than {} structures in one another", v.name, deepest));
        std::vector<std::string> fields;
        if (is_structure) {
            const element length = next(), names = next();
            const auto each = length.size == 4 ? integer<std::uint32_t>(length.at) : 0;
            if (length.type != 5 || each == 0)
                refuse(length.at,
                       fmt::format("{}: the length of the names of its fields is no number", v.name));
            if (names.size % each != 0)
                refuse(names.at, fmt::format("{}: the names of its fields have {} bytes, {} each", v.name,
                                             names.size, each));
            for (std::size_t k = 0; k < names.size; k += each)
                fields.push_back("." + text_at(names.at + k, each));
        } else {
            fields.emplace_back();
        }
        const std::uint64_t count = v.rows * v.columns;
        for (std::uint64_t k = 0; k < count && !fields.empty(); ++k)
            for (const std::string& field : fields) {
                const element part = next();
                if (part.type != matrix) refuse(part.at, fmt::format("{}{} is no variable", v.name, field));
                const std::string of =
                    count > 1 ? fmt::format("{}_{}{}", v.name, k + 1, field) : v.name + field;
                if (part.size > 0) read_variable(part, of, depth + 1);
            }
    }

    void read_numbers(variable& v) {
        const element e = next();
        constexpr std::size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8};
        const std::size_t each = e.type < std::size(sizes) ? sizes[e.type] : 0;
        if (each == 0) refuse(e.at, fmt::format("{}: numbers of type {} are not of level 5", v.name, e.type));
        if (e.size != v.rows * v.columns * each)
            refuse(e.at, fmt::format("{}: {} by {} numbers of {} bytes are not {} bytes", v.name, v.rows,
                                     v.columns, each, e.size));
        v.values.resize(e.size / each);
        for (std::size_t k = 0; k < v.values.size(); ++k) v.values[k] = number(e.type, e.at + k * each);
        if (v.columns > v.rows) transpose(v);
    }
    /// The rows of a matrix that is wider than long become its columns: the longer side is time.
    static void transpose(variable& v) {
        std::vector<double> turned(v.values.size());
        for (std::size_t k = 0; k < turned.size(); ++k)
            turned[k % v.rows * v.columns + k / v.rows] = v.values[k];
        v.values = std::move(turned);
        std::swap(v.rows, v.columns);
    }
    double number(std::uint32_t type, std::size_t at) const {
        switch (type) {
        case 1:
            return integer<std::int8_t>(at);
        case 2:
            return integer<std::uint8_t>(at);
        case 3:
            return integer<std::int16_t>(at);
        case 4:
            return integer<std::uint16_t>(at);
        case 5:
            return integer<std::int32_t>(at);
        case 6:
            return integer<std::uint32_t>(at);
        case 7:
            return static_cast<double>(integer<float>(at));
        case 9:
            return integer<double>(at);
        case 12:
            return static_cast<double>(integer<std::int64_t>(at));
        default:
            return static_cast<double>(integer<std::uint64_t>(at));
        }
    }

    /// Columns by the names of the variables; of a matrix name_1, name_2, ...
    std::string table() const {
        if (variables_.empty())
            throw bad_input(file_,
                            "holds no vector of numbers, alone or in a structure or cell (objects, such as a "
                            "timeseries or a table, are not read): save time, position and command as vectors");
        std::vector<number_column> columns;
        for (const variable& v : variables_)
            for (std::uint64_t k = 0; k < v.columns; ++k) {
                const auto begin = v.values.begin() + static_cast<std::ptrdiff_t>(k * v.rows);
                columns.push_back({v.columns > 1 ? fmt::format("{}_{}", v.name, k + 1) : v.name,
                                   {begin, begin + static_cast<std::ptrdiff_t>(v.rows)}});
            }
        return text_of_table(columns, file_);
    }

    std::string_view file_, file_bytes_, bytes_; ///< bytes_: of the file, or what a compressed variable holds
    std::size_t at_ = header, inside_ = 0; ///< inside_: where in the file the compressed variable is; 0: none
    std::size_t inflated_ = 0;             ///< bytes of the compressed variables so far
    bool swapped_ = false;
    std::vector<variable> variables_{};
};

} // namespace detail

/// Whether the bytes are a MATLAB MAT-file.
inline bool is_mat_file(std::string_view bytes) { return detail::mat_reader::is_one(bytes); }

/// The vectors and matrices of a MAT-file (level 5, also compressed) as a table of text whose first line names
/// the variables: what import_log reads. Those in a structure s are s.field, those in a cell c c_1, c_2, ...;
/// of a matrix the longer side is time. Not single numbers, texts and objects. Refuses other levels, complex
/// numbers, and a damaged file with its byte (bad_input).
inline std::string table_of_mat_file(std::string_view bytes, std::string_view file) {
    return detail::mat_reader(bytes, file).take();
}

} // namespace quadrant::inline v0::diagnosis
