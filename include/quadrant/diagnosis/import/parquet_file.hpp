// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "inflated.hpp"
#include "number_table.hpp"
#include "parquet_column.hpp"
#include "parquet_values.hpp"
#include "thrift.hpp"
#include "unsnapped.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

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
        const std::size_t size = parquet_word(bytes_, bytes_.size() - 8);
        if (size > bytes_.size() - 12) refuse("its footer is longer than the file");
        read_footer(thrift_struct(bytes_.substr(bytes_.size() - 8 - size, size), file_));
        std::vector<number_column> table;
        for (parquet_column& c : columns_)
            if (c.kept) table.push_back({c.name, std::move(c.values)});
        if (table.empty()) refuse("holds no column of numbers");
        if (table.front().values.empty()) refuse("holds no row");
        return text_of_table(table, file_);
    }

private:
    enum codec { uncompressed, snappy, gzip };
    static constexpr const char* codec_names[] = {"none",   "snappy", "gzip", "LZO",
                                                  "brotli", "LZ4",    "zstd", "LZ4_RAW"};
    enum encoding { plain = 0, plain_dictionary = 2, rle = 3, rle_dictionary = 8, byte_stream_split = 9 };
    static constexpr std::size_t most_numbers = std::size_t{1} << 25;

    [[noreturn]] void refuse(const std::string& why) const { throw bad_input(file_, why); }

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
            columns_.push_back(parquet_column::described(s, nested, file_));
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

    // --- a column of a row group ---

    void read_chunk(parquet_column& c, const thrift_struct& chunk) {
        if (!chunk.text(1).empty()) c.refuse("lies in another file");
        const auto data = chunk.inner(3);
        if (!data) c.refuse("has no description");
        const auto packing = data->integer(4, 0), count = data->integer(5, 0);
        if (packing > gzip)
            c.refuse(fmt::format("is compressed with {}: write it with snappy, gzip or none",
                                 packing < 8 ? codec_names[packing] : "a codec of no name"));
        const auto first = data->integer(9, -1), dictionary = data->integer(11, 0);
        const auto begin = dictionary > 0 && dictionary < first ? dictionary : first;
        if (begin < 0 || static_cast<std::uint64_t>(begin) >= bytes_.size() || count < 0)
            c.refuse("lies outside of the file");
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
                static_cast<std::uint64_t>(whole) > parquet_column::most_bytes)
                c.refuse("a page is longer than the file");
            const auto page = bytes_.substr(at, static_cast<std::size_t>(packed));
            at += page.size();
            read_page(c, header, page, static_cast<std::size_t>(whole), static_cast<int>(packing), end);
        }
        if (c.unit_s > 0 && rows_before == 0 && !c.values.empty()) start_s_ = c.values.front();
        if (c.unit_s > 0)
            for (std::size_t k = rows_before; k < c.values.size(); ++k) c.values[k] -= start_s_;
    }

    void read_page(parquet_column& c, const thrift_struct& header, std::string_view page, std::size_t whole,
                   int packing, std::size_t end) {
        constexpr std::int64_t data_page = 0, dictionary_page = 2, data_page_2 = 3;
        const auto type = header.integer(1, -1);
        const auto kind = header.inner(type == data_page ? 5 : type == dictionary_page ? 7 : 8);
        if (type != data_page && type != dictionary_page && type != data_page_2) return; // an index
        if (!kind) c.refuse("a page without its description");
        const auto given = kind->integer(1, -1);
        if (given < 0 || static_cast<std::uint64_t>(given) > most_numbers) c.refuse("a page with no count");
        const auto count = static_cast<std::size_t>(given);
        std::string unpacked;
        if (type == dictionary_page) {
            c.dictionary = plain_values_(c, inflate(c, page, whole, packing, unpacked), count);
            return;
        }
        if (c.values.size() + count > end) c.refuse("its pages hold more rows than it has");
        std::string_view levels, values;
        if (type == data_page) {
            values = inflate(c, page, whole, packing, unpacked);
            if (c.optional) { // length, then levels
                if (values.size() < 4 || parquet_word(values, 0) > values.size() - 4)
                    c.refuse("a page is too short");
                levels = values.substr(4, parquet_word(values, 0));
                values.remove_prefix(4 + levels.size());
            }
        } else {
            const auto defined = static_cast<std::size_t>(kind->integer(5, 0)),
                       repeats = static_cast<std::size_t>(kind->integer(6, 0));
            if (defined > page.size() || repeats > page.size() - defined || defined + repeats > whole)
                c.refuse("a page is too short");
            levels = page.substr(repeats, defined);
            values = page.substr(repeats + defined);
            if (kind->flag(7, true)) values = inflate(c, values, whole - defined - repeats, packing, unpacked);
        }
        add(c, count, levels, values, static_cast<int>(kind->integer(type == data_page ? 2 : 4, -1)));
    }

    void add(parquet_column& c, std::size_t count, std::string_view levels, std::string_view values, int how) {
        std::vector<std::uint32_t> there(count, 1);
        if (c.optional) there = parquet_runs(c, levels, 1, count);
        const auto present = static_cast<std::size_t>(std::count(there.begin(), there.end(), 1U));
        std::vector<double> found;
        if (how == plain) {
            found = plain_values_(c, values, present);
        } else if (how == plain_dictionary || how == rle_dictionary) {
            const auto width = values.empty() ? 0U : static_cast<unsigned char>(values[0]);
            if (width > 32) c.refuse("an index of more than 32 bits");
            for (const auto k :
                 parquet_runs(c, values.substr(std::min<std::size_t>(1, values.size())), width, present)) {
                if (k >= c.dictionary.size()) c.refuse("an index beyond its dictionary");
                found.push_back(c.dictionary[k]);
            }
        } else if (how == rle && c.type == parquet_column::boolean) {
            if (values.size() < 4) c.refuse("a page is too short");
            for (const auto k : parquet_runs(c, values.substr(4), 1, present)) found.push_back(k);
        } else if (how == byte_stream_split &&
                   (c.type == parquet_column::of_float || c.type == parquet_column::of_double)) {
            const std::size_t each = c.type == parquet_column::of_float ? 4 : 8;
            if (values.size() < each * present) c.refuse("a page is too short");
            std::string joined(each * present, '\0');
            for (std::size_t k = 0; k < present; ++k)
                for (std::size_t b = 0; b < each; ++b) joined[k * each + b] = values[b * present + k];
            found = plain_values_(c, joined, present);
        } else {
            c.refuse(fmt::format("has encoding {}: write it plain or by dictionary", how));
        }
        std::size_t next = 0;
        for (const auto t : there)
            c.values.push_back(t ? found[next++] : std::numeric_limits<double>::quiet_NaN());
    }

    // --- compression ---

    std::string_view inflate(const parquet_column& c, std::string_view page, std::size_t whole, int packing,
                             std::string& into) const {
        if (packing == uncompressed) return page;
        if (packing == snappy) {
            into = unsnapped(page, whole, [&](const char* why) { c.refuse(why); });
        } else {
            constexpr std::size_t head = 10; // of gzip, where it has no name in it
            if (page.size() < head || page.substr(0, 3) != std::string_view("\x1f\x8b\x08", 3) || page[3] != 0)
                c.refuse("no gzip stream begins where one should");
            inflation out = inflated(page.substr(head), whole);
            if (!out.whole || out.text.size() != whole) c.refuse("a gzip stream is broken");
            into = std::move(out.text);
        }
        return into;
    }

    std::string_view file_, bytes_;
    std::vector<parquet_column> columns_{};
    std::size_t numbers_ = 0; ///< of all columns so far
    parquet_plain_values plain_values_{};
    double start_s_ = 0; ///< of the first row, from there
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
