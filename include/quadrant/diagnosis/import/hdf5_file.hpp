// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "hdf5_bytes.hpp"
#include "hdf5_dataset.hpp"
#include "hdf5_elements.hpp"
#include "number_table.hpp"

#include <cstdint>
#include <set>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// An HDF5 file on its way to a table of text: vectors and matrices of numbers in the layout that MATLAB
/// (-v7.3) and h5py write by default: superblock 0 or 1, symbol tables, whole or in chunks, with deflate,
/// shuffle and checksums.
class hdf5_reader {
public:
    hdf5_reader(std::string_view bytes, std::string_view file)
        : file_(bytes, file), name_(file), begin_(hdf5_bytes::begin_of(bytes)) {}

    static bool is_one(std::string_view bytes) { return hdf5_bytes::begin_of(bytes) != bytes.npos; }

    std::string take() {
        matlab_ = file_.begins_with("MATLAB ");
        const auto version = file_.number<std::uint8_t>(begin_ + 8);
        if (version > 1)
            file_.refuse("has the layout of newer files (superblock " + fmt::format("{}", version) +
                         "): write it with libver='earliest', or save it as CSV");
        if (file_.number<std::uint8_t>(begin_ + 13) != 8 || file_.number<std::uint8_t>(begin_ + 14) != 8)
            file_.refuse("has addresses that are not 8 bytes long");
        const std::size_t after = begin_ + (version == 0 ? 24 : 28);
        file_.base(file_.number<std::uint64_t>(after));
        read_object(file_.number<std::uint64_t>(after + 40), "", 0);
        if (columns_.empty())
            file_.refuse("holds no vector of numbers: save time, position and command as vectors");
        return text_of_table(columns_, name_);
    }

private:
    struct message {
        unsigned type;
        std::string_view data;
    };

    std::vector<message> messages_of(std::uint64_t header) const {
        if (file_.is(header, "OHDR"))
            file_.refuse(
                "has the layout of newer files (object headers 2): write it with libver='earliest', or save "
                "it as "
                "CSV");
        if (file_.number<std::uint8_t>(header) != 1) file_.damaged(header);
        std::size_t left = file_.number<std::uint16_t>(header + 2);
        std::vector<std::pair<std::uint64_t, std::uint64_t>> blocks{
            {header + 16, file_.number<std::uint32_t>(header + 8)}};
        std::vector<message> out;
        for (std::size_t b = 0; b < blocks.size() && b < 1000; ++b) {
            auto [at, size] = blocks[b];
            file_.part(at, size);
            for (const std::uint64_t end = at + size; at + 8 <= end && left > 0; --left) {
                const auto type = file_.number<std::uint16_t>(at), length = file_.number<std::uint16_t>(at + 2);
                const auto data = file_.part(at + 8, length);
                at += 8 + length;
                if (type == 0x10 && data.size() >= 16)
                    blocks.emplace_back(file_.place(little_endian<std::uint64_t>(data)),
                                        little_endian<std::uint64_t>(data.substr(8)));
                else
                    out.push_back({type, data});
            }
        }
        return out;
    }

    void read_object(std::uint64_t address, const std::string& name, int depth) {
        if (depth > hdf5_bytes::deepest || !seen_.insert(address).second) return; // a link back
        hdf5_dataset d;
        for (const message& m : messages_of(file_.place(address))) {
            switch (m.type) {
            case 0x01:
                d.space(m.data);
                break;
            case 0x03:
                if (!d.element(m.data)) file_.damaged(file_.place(address));
                break;
            case 0x08:
                d.layout = m.data;
                break;
            case 0x0b:
                d.filters = m.data;
                break;
            case 0x0c:
                d.attribute(m.data);
                break;
            case 0x11:
                if (m.data.size() < 16) file_.damaged(file_.place(address));
                read_group(little_endian<std::uint64_t>(m.data), little_endian<std::uint64_t>(m.data.substr(8)),
                           depth);
                return;
            default:
                break;
            }
        }
        if (d.has_space && !d.layout.empty()) read_dataset(d, name);
    }

    void read_group(std::uint64_t tree, std::uint64_t heap, int depth) {
        const std::uint64_t h = file_.place(heap);
        if (!file_.is(h, "HEAP")) file_.damaged(h);
        const auto names =
            file_.part(file_.place(file_.number<std::uint64_t>(h + 24)), file_.number<std::uint64_t>(h + 8));
        file_.for_each_leaf(file_.place(tree), 0, 8, 0, [&](std::uint64_t, std::uint64_t child) {
            const std::uint64_t node = file_.place(child);
            if (!file_.is(node, "SNOD")) file_.damaged(node);
            const unsigned count = file_.number<std::uint16_t>(node + 6);
            for (unsigned k = 0; k < count; ++k) {
                const std::uint64_t entry = node + 8 + 40 * std::uint64_t{k},
                                    offset = file_.number<std::uint64_t>(entry);
                if (offset >= names.size()) file_.damaged(entry);
                const auto from = names.substr(static_cast<std::size_t>(offset));
                const std::string name = column_name(from.substr(0, from.find('\0')));
                if (name.starts_with('#')) continue; // what MATLAB keeps for itself
                read_object(file_.number<std::uint64_t>(entry + 8), name, depth + 1);
            }
        });
    }

    void read_dataset(const hdf5_dataset& d, const std::string& name) {
        if (!d.holds_numbers() || d.dimensions.empty()) return;
        std::uint64_t count = 1;
        for (const auto n : d.dimensions) {
            if (n == 0) return;
            if (n > hdf5_bytes::most_numbers / count)
                file_.refuse(fmt::format("{}: holds more than {} million numbers", name,
                                         hdf5_bytes::most_numbers >> 20));
            count *= n;
        }
        if (count < 2) return; // a single number
        numbers_ += count;
        if (numbers_ > hdf5_bytes::most_numbers)
            file_.refuse(fmt::format("holds more than {} million numbers", hdf5_bytes::most_numbers >> 20));
        std::vector<std::uint64_t> large;
        for (const auto n : d.dimensions)
            if (n > 1) large.push_back(n);
        if (large.size() > 2) return; // an array of three dimensions is no table
        const std::string data = hdf5_elements(file_).bytes_of(d, name, count);
        std::vector<double> values(static_cast<std::size_t>(count));
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = d.value(std::string_view(data).substr(k * d.size, d.size));
        if (large.size() == 1) return add(name, std::move(values));
        // MATLAB's columns are the rows of its datasets.
        const auto rows = static_cast<std::size_t>(matlab_ ? large[1] : large[0]),
                   columns = static_cast<std::size_t>(matlab_ ? large[0] : large[1]);
        for (std::size_t c = 0; c < columns; ++c) {
            std::vector<double> column(rows);
            for (std::size_t r = 0; r < rows; ++r) column[r] = values[matlab_ ? c * rows + r : r * columns + c];
            add(fmt::format("{}_{}", name, c + 1), std::move(column));
        }
    }
    void add(const std::string& name, std::vector<double> values) {
        constexpr std::size_t most = 10000;
        if (columns_.size() == most)
            file_.refuse(name + " is one column too many: " + std::to_string(most) +
                         " are read; is a matrix transposed?");
        if (!names_.insert(name).second) file_.refuse(name + " stands in two groups: keep one log in the file");
        columns_.push_back({name, std::move(values)});
    }

    hdf5_bytes file_;
    std::string_view name_;
    std::size_t begin_; ///< of the HDF5 file in the bytes
    std::uint64_t numbers_ = 0;
    bool matlab_ = false;
    std::set<std::uint64_t> seen_{};
    std::set<std::string> names_{}; ///< of the columns
    std::vector<number_column> columns_{};
};

} // namespace detail

/// Whether the bytes are an HDF5 file, or one inside a MAT-file of level 7.3.
inline bool is_hdf5_file(std::string_view bytes) { return detail::hdf5_reader::is_one(bytes); }

/// The vectors and matrices of numbers of an HDF5 file or of a MAT-file of level 7.3 as a table of text whose
/// first line names them: what import_log reads. Single numbers, texts, compounds and cells are left out.
/// Refuses the layouts of libver='latest', other filters than deflate, shuffle and checksums, and a damaged
/// file (bad_input).
inline std::string table_of_hdf5_file(std::string_view bytes, std::string_view file) {
    return detail::hdf5_reader(bytes, file).take();
}

} // namespace quadrant::inline v0::diagnosis
