// SPDX-License-Identifier: BSL-1.0
// Long: one file format, read without its library: the structures of its specification one after the other.
#pragma once
#include "../../base/portable.hpp"
#include "inflated.hpp"
#include "number_table.hpp"
#include "thrift.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// A Parquet file on its way to a table of text: flat columns of numbers, plain or by dictionary or split by
/// bytes, uncompressed or with snappy or gzip, as pandas, pyarrow, polars and DuckDB write them by default.
class parquet_reader {
public:
    parquet_reader(std::string_view bytes, std::string_view file) : file_(file), bytes_(bytes) {}

    static bool is_one(std::string_view bytes) {
        return bytes.size() >= 12 && bytes.starts_with("PAR1") &&
               (bytes.ends_with("PAR1") || bytes.ends_with("PARE"));
    }

    std::string take() {
        if (bytes_.ends_with("PARE")) refuse("is encrypted");
        const std::size_t size = word(bytes_, bytes_.size() - 8);
        if (size > bytes_.size() - 12) refuse("its footer is longer than the file");
        read_footer(thrift_struct(bytes_.substr(bytes_.size() - 8 - size, size), file_));
        std::vector<number_column> table;
        for (column& c : columns_)
            if (c.kept) table.push_back({c.name, std::move(c.values)});
        if (table.empty()) refuse("holds no column of numbers");
        if (table.front().values.empty()) refuse("holds no row");
        return text_of_table(table, file_);
    }

private:
    enum physical { boolean, int32, int64, int96, of_float, of_double, byte_array, fixed };
    enum codec { uncompressed, snappy, gzip };
    static constexpr const char* codec_names[] = {"none",   "snappy", "gzip", "LZO",
                                                  "brotli", "LZ4",    "zstd", "LZ4_RAW"};
    enum encoding { plain = 0, plain_dictionary = 2, rle = 3, rle_dictionary = 8, byte_stream_split = 9 };
    static constexpr std::size_t most = std::size_t{1} << 28, ///< bytes of a page
        most_numbers = std::size_t{1} << 25;

    struct column {
        std::string name;
        int type = of_double;
        bool kept = false, optional = false, is_unsigned = false;
        double unit_s = 0; ///< of a time stamp [s]; 0: it is none
        std::vector<double> dictionary{}, values{};
    };

    [[noreturn]] void refuse(const std::string& why) const { throw bad_input(file_, why); }
    [[noreturn]] void refuse(const column& c, const std::string& message) const {
        refuse("column " + c.name + ": " + message);
    }

    static std::uint32_t word(std::string_view from, std::size_t at) {
        std::uint32_t out = 0;
        for (std::size_t k = 0; k < 4; ++k)
            out |= static_cast<std::uint32_t>(static_cast<unsigned char>(from[at + k])) << (8 * k);
        return out;
    }

    // --- the footer ---

    void read_footer(const thrift_struct& footer) {
        const auto schema = footer.structs(2);
        if (schema.empty()) refuse("its footer names no column");
        std::size_t inside = 0; // elements of groups that are still to come
        for (std::size_t k = 1; k < schema.size(); ++k) {
            const thrift_struct& s = schema[k];
            const auto children = static_cast<std::size_t>(s.integer(5, 0));
            if (children > schema.size()) refuse("its footer is damaged");
            const bool nested = inside > 0;
            if (inside > 0) --inside;
            inside += children;
            if (children > 0) continue;
            columns_.push_back(described(s, nested));
        }
        for (const thrift_struct& group : footer.structs(4)) {
            const auto chunks = group.structs(1);
            if (chunks.size() != columns_.size())
                refuse(
                    fmt::format("a row group has {} columns, the schema {}", chunks.size(), columns_.size()));
            for (std::size_t c = 0; c < chunks.size(); ++c)
                if (columns_[c].kept) read_chunk(columns_[c], chunks[c]);
        }
    }
    static column described(const thrift_struct& s, bool nested) {
        constexpr std::int64_t repeated = 2, millis = 9, micros = 10, first_unsigned = 11, last_unsigned = 14;
        column c{.name = column_name(s.text(4))};
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

    // --- a column of a row group ---

    void read_chunk(column& c, const thrift_struct& chunk) {
        if (!chunk.text(1).empty()) refuse(c, "lies in another file");
        const auto data = chunk.inner(3);
        if (!data) refuse(c, "has no description");
        const auto packing = data->integer(4, 0), count = data->integer(5, 0);
        if (packing > gzip)
            refuse(c, fmt::format("is compressed with {}: write it with snappy, gzip or none",
                                  packing < 8 ? codec_names[packing] : "a codec of no name"));
        const auto first = data->integer(9, -1), dictionary = data->integer(11, 0);
        const auto begin = dictionary > 0 && dictionary < first ? dictionary : first;
        if (begin < 0 || static_cast<std::uint64_t>(begin) >= bytes_.size() || count < 0)
            refuse(c, "lies outside of the file");
        if (static_cast<std::uint64_t>(count) > most_numbers - numbers_)
            refuse(fmt::format("holds more than {} million numbers", most_numbers >> 20));
        numbers_ += static_cast<std::size_t>(count);
        auto at = static_cast<std::size_t>(begin);
        const std::size_t end = c.values.size() + static_cast<std::size_t>(count),
                          rows_before = c.values.size();
        c.dictionary.clear();
        while (c.values.size() < end) {
            thrift_struct header(bytes_.substr(at), file_);
            at += header.bytes();
            const auto packed = header.integer(3, -1), whole = header.integer(2, -1);
            if (packed < 0 || whole < 0 || static_cast<std::uint64_t>(packed) > bytes_.size() - at ||
                static_cast<std::uint64_t>(whole) > most)
                refuse(c, "a page is longer than the file");
            const auto page = bytes_.substr(at, static_cast<std::size_t>(packed));
            at += page.size();
            read_page(c, header, page, static_cast<std::size_t>(whole), static_cast<int>(packing), end);
        }
        if (c.unit_s > 0 && rows_before == 0 && !c.values.empty()) start_s_ = c.values.front();
        if (c.unit_s > 0)
            for (std::size_t k = rows_before; k < c.values.size(); ++k) c.values[k] -= start_s_;
    }

    void read_page(column& c, const thrift_struct& header, std::string_view page, std::size_t whole,
                   int packing, std::size_t end) {
        constexpr std::int64_t data_page = 0, dictionary_page = 2, data_page_2 = 3;
        const auto type = header.integer(1, -1);
        const auto kind = header.inner(type == data_page ? 5 : type == dictionary_page ? 7 : 8);
        if (type != data_page && type != dictionary_page && type != data_page_2) return; // an index
        if (!kind) refuse(c, "a page without its description");
        const auto given = kind->integer(1, -1);
        if (given < 0 || static_cast<std::uint64_t>(given) > most_numbers) refuse(c, "a page with no count");
        const auto count = static_cast<std::size_t>(given);
        std::string unpacked;
        if (type == dictionary_page) {
            c.dictionary = plain_values(c, inflate(c, page, whole, packing, unpacked), count);
            return;
        }
        if (c.values.size() + count > end) refuse(c, "its pages hold more rows than it has");
        std::string_view levels, values;
        if (type == data_page) {
            values = inflate(c, page, whole, packing, unpacked);
            if (c.optional) { // length, then levels
                if (values.size() < 4 || word(values, 0) > values.size() - 4) refuse(c, "a page is too short");
                levels = values.substr(4, word(values, 0));
                values.remove_prefix(4 + levels.size());
            }
        } else {
            const auto defined = static_cast<std::size_t>(kind->integer(5, 0)),
                       repeats = static_cast<std::size_t>(kind->integer(6, 0));
            if (defined > page.size() || repeats > page.size() - defined || defined + repeats > whole)
                refuse(c, "a page is too short");
            levels = page.substr(repeats, defined);
            values = page.substr(repeats + defined);
            if (kind->flag(7, true)) values = inflate(c, values, whole - defined - repeats, packing, unpacked);
        }
        add(c, count, levels, values, static_cast<int>(kind->integer(type == data_page ? 2 : 4, -1)));
    }

    void add(column& c, std::size_t count, std::string_view levels, std::string_view values, int how) {
        std::vector<std::uint32_t> there(count, 1);
        if (c.optional) there = hybrid(c, levels, 1, count);
        const auto present = static_cast<std::size_t>(std::count(there.begin(), there.end(), 1U));
        std::vector<double> found;
        if (how == plain) {
            found = plain_values(c, values, present);
        } else if (how == plain_dictionary || how == rle_dictionary) {
            const auto width = values.empty() ? 0U : static_cast<unsigned char>(values[0]);
            if (width > 32) refuse(c, "an index of more than 32 bits");
            for (const auto k :
                 hybrid(c, values.substr(std::min<std::size_t>(1, values.size())), width, present)) {
                if (k >= c.dictionary.size()) refuse(c, "an index beyond its dictionary");
                found.push_back(c.dictionary[k]);
            }
        } else if (how == rle && c.type == boolean) {
            if (values.size() < 4) refuse(c, "a page is too short");
            for (const auto k : hybrid(c, values.substr(4), 1, present)) found.push_back(k);
        } else if (how == byte_stream_split && (c.type == of_float || c.type == of_double)) {
            const std::size_t each = c.type == of_float ? 4 : 8;
            if (values.size() < each * present) refuse(c, "a page is too short");
            std::string joined(each * present, '\0');
            for (std::size_t k = 0; k < present; ++k)
                for (std::size_t b = 0; b < each; ++b) joined[k * each + b] = values[b * present + k];
            found = plain_values(c, joined, present);
        } else {
            refuse(c, fmt::format("has encoding {}: write it plain or by dictionary", how));
        }
        std::size_t next = 0;
        for (const auto t : there)
            c.values.push_back(t ? found[next++] : std::numeric_limits<double>::quiet_NaN());
    }

    // --- values ---

    std::vector<double> plain_values(const column& c, std::string_view from, std::size_t count) {
        std::vector<double> out;
        const std::size_t each = c.type == int32 || c.type == of_float ? 4 : 8;
        if (from.size() < (c.type == boolean ? (count + 7) / 8 : count * each))
            refuse(c, "a page is too short");
        out.reserve(count);
        for (std::size_t k = 0; k < count; ++k) {
            if (c.type == boolean) {
                out.push_back((static_cast<unsigned char>(from[k / 8]) >> (k % 8)) & 1);
                continue;
            }
            const std::uint64_t low = word(from, k * each), high = each == 8 ? word(from, k * each + 4) : 0,
                                raw = high << 32 | low;
            if (c.type == of_double)
                out.push_back(quadrant::detail::bits_as<double>(raw));
            else if (c.type == of_float)
                out.push_back(
                    static_cast<double>(quadrant::detail::bits_as<float>(static_cast<std::uint32_t>(raw))));
            else if (c.unit_s > 0) {
                if (!epoch_) epoch_ = static_cast<std::int64_t>(raw);
                out.push_back(c.unit_s * static_cast<double>(static_cast<std::int64_t>(
                                             raw - static_cast<std::uint64_t>(*epoch_))));
            } else if (c.is_unsigned)
                out.push_back(static_cast<double>(raw));
            else
                out.push_back(each == 4 ? static_cast<double>(static_cast<std::int32_t>(low))
                                        : static_cast<double>(static_cast<std::int64_t>(raw)));
        }
        return out;
    }

    /// Runs and packed groups of eight, mixed: levels and indices.
    std::vector<std::uint32_t> hybrid(const column& c, std::string_view from, unsigned width,
                                      std::size_t count) const {
        std::vector<std::uint32_t> out;
        out.reserve(count);
        std::size_t at = 0;
        const std::size_t bytes = (width + 7) / 8;
        while (out.size() < count) {
            std::uint64_t head = 0;
            unsigned shift = 0;
            for (;; shift += 7) {
                if (at >= from.size() || shift > 35) refuse(c, "a page is too short");
                const auto b = static_cast<unsigned char>(from[at++]);
                head |= static_cast<std::uint64_t>(b & 0x7f) << shift;
                if (!(b & 0x80)) break;
            }
            if (head & 1) {
                const std::uint64_t groups = head >> 1;
                if (groups == 0 || groups > most || groups * width > from.size() - at) {
                    // The last group may be cut where no value needs it.
                    if (groups == 0 || groups > most) refuse(c, "a page is too short");
                }
                for (std::uint64_t k = 0; k < groups * 8 && out.size() < count; ++k) {
                    std::uint64_t value = 0;
                    const std::uint64_t bit = k * width;
                    for (unsigned b = 0; b < width; ++b) {
                        const auto byte = at + static_cast<std::size_t>((bit + b) / 8);
                        if (byte >= from.size()) refuse(c, "a page is too short");
                        value |= static_cast<std::uint64_t>(
                                     (static_cast<unsigned char>(from[byte]) >> ((bit + b) % 8)) & 1)
                                 << b;
                    }
                    out.push_back(static_cast<std::uint32_t>(value));
                }
                at += static_cast<std::size_t>(std::min<std::uint64_t>(groups * width, from.size() - at));
            } else {
                const std::uint64_t times = head >> 1;
                if (times == 0 || bytes > from.size() - at) refuse(c, "a page is too short");
                std::uint32_t value = 0;
                for (std::size_t b = 0; b < bytes; ++b)
                    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(from[at + b])) << (8 * b);
                at += bytes;
                for (std::uint64_t k = 0; k < times && out.size() < count; ++k) out.push_back(value);
            }
        }
        return out;
    }

    // --- compression ---

    std::string_view inflate(const column& c, std::string_view page, std::size_t whole, int packing,
                             std::string& into) const {
        if (packing == uncompressed) return page;
        if (packing == snappy) {
            into = unsnapped(c, page, whole);
        } else {
            constexpr std::size_t head = 10; // of gzip, where it has no name in it
            if (page.size() < head || page.substr(0, 3) != std::string_view("\x1f\x8b\x08", 3) || page[3] != 0)
                refuse(c, "no gzip stream begins where one should");
            inflation out = inflated(page.substr(head), whole);
            if (!out.whole || out.text.size() != whole) refuse(c, "a gzip stream is broken");
            into = std::move(out.text);
        }
        return into;
    }

    std::string unsnapped(const column& c, std::string_view from, std::size_t whole) const {
        std::size_t at = 0;
        const auto next = [&] {
            if (at >= from.size()) refuse(c, "a snappy stream is broken");
            return static_cast<std::size_t>(static_cast<unsigned char>(from[at++]));
        };
        const auto little = [&](std::size_t bytes) {
            std::size_t out = 0;
            for (std::size_t k = 0; k < bytes; ++k) out |= next() << (8 * k);
            return out;
        };
        std::size_t size = 0;
        for (unsigned shift = 0;; shift += 7) {
            const std::size_t b = next();
            if (shift > 28) refuse(c, "a snappy stream is broken");
            size |= (b & 0x7f) << shift;
            if (b < 0x80) break;
        }
        if (size != whole) refuse(c, "a snappy stream is of another length");
        std::string out;
        out.reserve(size);
        while (at < from.size()) {
            const std::size_t tag = next(), kind = tag & 3;
            std::size_t length = tag >> 2, back = 0;
            if (kind == 0) {
                if (length >= 60) length = little(length - 59);
                ++length;
                if (length > from.size() - at || out.size() + length > size)
                    refuse(c, "a snappy stream is broken");
                out += from.substr(at, length);
                at += length;
                continue;
            }
            if (kind == 1) {
                back = (tag >> 5) << 8 | next();
                length = ((tag >> 2) & 7) + 4;
            } else {
                ++length;
                back = little(kind == 2 ? 2 : 4);
            }
            if (back == 0 || back > out.size() || out.size() + length > size)
                refuse(c, "a snappy stream is broken");
            for (std::size_t k = 0; k < length; ++k) out += out[out.size() - back]; // they may overlap
        }
        if (out.size() != size) refuse(c, "a snappy stream is broken");
        return out;
    }

    std::string_view file_, bytes_;
    std::vector<column> columns_{};
    std::size_t numbers_ = 0;             ///< of all columns so far
    std::optional<std::int64_t> epoch_{}; ///< near the time stamps: a double does not hold nanoseconds of 1970
    double start_s_ = 0;                  ///< of the first row, from there
};

} // namespace detail

/// Whether the bytes are a Parquet file.
inline bool is_parquet_file(std::string_view bytes) { return detail::parquet_reader::is_one(bytes); }

/// The columns of numbers of a Parquet file as a table of text whose first line names them: what import_log
/// reads. Time stamps become seconds from the first row. Texts, decimals and nested columns are left out; no
/// value is an empty cell. Refuses encryption, other compressions than snappy and gzip, other encodings than
/// plain, dictionary, run lengths of flags and split bytes, and a damaged file (bad_input).
inline std::string table_of_parquet_file(std::string_view bytes, std::string_view file) {
    return detail::parquet_reader(bytes, file).take();
}

} // namespace quadrant::inline v0::diagnosis
