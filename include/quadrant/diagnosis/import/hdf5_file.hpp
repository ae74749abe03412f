// SPDX-License-Identifier: BSL-1.0
// Long: one file format, read without its library: the structures of its specification one after the other.
#pragma once
#include "../../base/portable.hpp"
#include "inflated.hpp"
#include "number_table.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// An HDF5 file on its way to a table of text: vectors and matrices of numbers in the layout that MATLAB
/// (-v7.3) and h5py write by default: superblock 0 or 1, symbol tables, whole or in chunks, with deflate,
/// shuffle and checksums.
class hdf5_reader {
public:
    hdf5_reader(std::string_view bytes, std::string_view file) : file_(file), bytes_(bytes) {}

    static bool is_one(std::string_view bytes) { return begin_of(bytes) != bytes.npos; }

    std::string take() {
        const std::size_t begin = begin_of(bytes_);
        matlab_ = bytes_.starts_with("MATLAB ");
        const auto version = number<std::uint8_t>(begin + 8);
        if (version > 1)
            refuse("has the layout of newer files (superblock " + fmt::format("{}", version) +
                   "): write it with libver='earliest', or save it as CSV");
        if (number<std::uint8_t>(begin + 13) != 8 || number<std::uint8_t>(begin + 14) != 8)
            refuse("has addresses of another size than 8 bytes");
        const std::size_t after = begin + (version == 0 ? 24 : 28);
        base_ = number<std::uint64_t>(after);
        read_object(number<std::uint64_t>(after + 40), "", 0);
        if (columns_.empty()) refuse("holds no vector of numbers: save time, position and command as vectors");
        return text_of_table(columns_, file_);
    }

private:
    static constexpr std::string_view signature{"\x89HDF\r\n\x1a\n", 8};
    static constexpr std::uint64_t none = ~std::uint64_t{0};
    static constexpr std::uint64_t most_numbers = std::uint64_t{1} << 25;
    static constexpr int deepest = 16;

    /// The signature stands at 0, 512, 1024, 2048, ...
    static std::size_t begin_of(std::string_view bytes) {
        for (std::size_t at = 0; at + 96 <= bytes.size(); at = at == 0 ? 512 : 2 * at)
            if (bytes.substr(at, signature.size()) == signature) return at;
        return bytes.npos;
    }

    [[noreturn]] void refuse(const std::string& why) const { throw bad_input(file_, why); }
    [[noreturn]] void damaged(std::uint64_t at) const {
        refuse(fmt::format("byte {}: the file is damaged", at));
    }

    template <class T> T number(std::uint64_t at) const {
        if (bytes_.size() < sizeof(T) || at > bytes_.size() - sizeof(T))
            damaged(std::min<std::uint64_t>(at, bytes_.size()));
        return little<T>(bytes_.substr(static_cast<std::size_t>(at), sizeof(T)));
    }
    template <class T> static T little(std::string_view from) {
        std::uint64_t out = 0;
        for (std::size_t k = 0; k < sizeof(T); ++k)
            out |= static_cast<std::uint64_t>(static_cast<unsigned char>(from[k])) << (8 * k);
        return static_cast<T>(out);
    }
    std::uint64_t place(std::uint64_t address) const {
        const std::uint64_t at = address + base_;
        if (address == none || at < address || at >= bytes_.size())
            damaged(std::min<std::uint64_t>(at, bytes_.size()));
        return at;
    }
    std::string_view part(std::uint64_t at, std::uint64_t size) const {
        if (at > bytes_.size() || size > bytes_.size() - at)
            damaged(std::min<std::uint64_t>(at, bytes_.size()));
        return bytes_.substr(static_cast<std::size_t>(at), static_cast<std::size_t>(size));
    }
    bool is(std::uint64_t at, std::string_view word) const { return part(at, word.size()) == word; }

    // --- objects ---

    struct dataset {
        std::vector<std::uint64_t> dimensions{};
        bool has_space = false;
        unsigned type = 0, bits = 0, size = 0; ///< class, bit field and bytes of an element
        unsigned precision = 0;
        std::string_view layout{}, filters{};
        std::string words{}; ///< of MATLAB_class
    };
    struct message {
        unsigned type;
        std::string_view data;
    };

    std::vector<message> messages_of(std::uint64_t header) const {
        if (is(header, "OHDR"))
            refuse("has the layout of newer files (object headers 2): write it with libver='earliest', or save "
                   "it as "
                   "CSV");
        if (number<std::uint8_t>(header) != 1) damaged(header);
        std::size_t left = number<std::uint16_t>(header + 2);
        std::vector<std::pair<std::uint64_t, std::uint64_t>> blocks{
            {header + 16, number<std::uint32_t>(header + 8)}};
        std::vector<message> out;
        for (std::size_t b = 0; b < blocks.size() && b < 1000; ++b) {
            auto [at, size] = blocks[b];
            part(at, size);
            for (const std::uint64_t end = at + size; at + 8 <= end && left > 0; --left) {
                const auto type = number<std::uint16_t>(at), length = number<std::uint16_t>(at + 2);
                const auto data = part(at + 8, length);
                at += 8 + length;
                if (type == 0x10 && data.size() >= 16)
                    blocks.emplace_back(place(little<std::uint64_t>(data)),
                                        little<std::uint64_t>(data.substr(8)));
                else
                    out.push_back({type, data});
            }
        }
        return out;
    }

    void read_object(std::uint64_t address, const std::string& name, int depth) {
        if (depth > deepest || !seen_.insert(address).second) return; // a link back
        dataset d;
        for (const message& m : messages_of(place(address))) {
            switch (m.type) {
            case 0x01:
                read_space(d, m.data);
                break;
            case 0x03:
                if (m.data.size() < 8) damaged(place(address));
                d.type = static_cast<unsigned char>(m.data[0]) & 0x0f;
                d.bits = little<std::uint32_t>(m.data) >> 8;
                d.size = little<std::uint32_t>(m.data.substr(4));
                d.precision = m.data.size() >= 12 ? little<std::uint16_t>(m.data.substr(10)) : 0;
                break;
            case 0x08:
                d.layout = m.data;
                break;
            case 0x0b:
                d.filters = m.data;
                break;
            case 0x0c:
                read_attribute(d, m.data);
                break;
            case 0x11:
                if (m.data.size() < 16) damaged(place(address));
                read_group(little<std::uint64_t>(m.data), little<std::uint64_t>(m.data.substr(8)), depth);
                return;
            default:
                break;
            }
        }
        if (d.has_space && !d.layout.empty()) read_dataset(d, name);
    }

    void read_group(std::uint64_t tree, std::uint64_t heap, int depth) {
        const std::uint64_t h = place(heap);
        if (!is(h, "HEAP")) damaged(h);
        const auto names = part(place(number<std::uint64_t>(h + 24)), number<std::uint64_t>(h + 8));
        for_each_leaf(place(tree), 0, 8, 0, [&](std::uint64_t, std::uint64_t child) {
            const std::uint64_t node = place(child);
            if (!is(node, "SNOD")) damaged(node);
            const unsigned count = number<std::uint16_t>(node + 6);
            for (unsigned k = 0; k < count; ++k) {
                const std::uint64_t entry = node + 8 + 40 * std::uint64_t{k},
                                    offset = number<std::uint64_t>(entry);
                if (offset >= names.size()) damaged(entry);
                const auto from = names.substr(static_cast<std::size_t>(offset));
                const std::string name = column_name(from.substr(0, from.find('\0')));
                if (name.starts_with('#')) continue; // what MATLAB keeps for itself
                read_object(number<std::uint64_t>(entry + 8), name, depth + 1);
            }
        });
    }

    /// Calls leaf(place of the key, address of the child) for every child of the lowest level of a B-tree.
    template <class Leaf>
    void for_each_leaf(std::uint64_t node, unsigned kind, std::uint64_t key, int depth, const Leaf& leaf) {
        if (depth > deepest || !is(node, "TREE") || number<std::uint8_t>(node + 4) != kind) damaged(node);
        const unsigned level = number<std::uint8_t>(node + 5), count = number<std::uint16_t>(node + 6);
        for (unsigned k = 0; k < count; ++k) {
            const std::uint64_t at = node + 24 + k * (key + 8), child = number<std::uint64_t>(at + key);
            if (level > 0)
                for_each_leaf(place(child), kind, key, depth + 1, leaf);
            else
                leaf(at, child);
        }
    }

    // --- what describes a dataset ---

    void read_space(dataset& d, std::string_view m) const {
        if (m.size() < 4) return;
        const auto version = static_cast<unsigned char>(m[0]), rank = static_cast<unsigned char>(m[1]);
        const std::size_t from = version == 1 ? 8 : 4;
        if (rank > 32 || m.size() < from + 8 * std::size_t{rank}) return;
        for (std::size_t k = 0; k < rank; ++k)
            d.dimensions.push_back(little<std::uint64_t>(m.substr(from + 8 * k)));
        d.has_space = true;
    }
    static void read_attribute(dataset& d, std::string_view m) {
        if (m.size() < 8) return;
        const unsigned version = static_cast<unsigned char>(m[0]);
        const auto aligned = [&](std::size_t n) { return version == 1 ? (n + 7) / 8 * 8 : n; };
        const std::size_t name = little<std::uint16_t>(m.substr(2)), type = little<std::uint16_t>(m.substr(4)),
                          space = little<std::uint16_t>(m.substr(6)), from = version == 3 ? 9 : 8,
                          data = from + aligned(name) + aligned(type) + aligned(space);
        if (m.size() < data || m.substr(from, name).find("MATLAB_class") != 0) return;
        d.words = m.substr(data);
        if (const auto end = d.words.find('\0'); end != d.words.npos) d.words.resize(end);
    }

    // --- numbers ---

    bool holds_numbers(const dataset& d) const {
        if (d.words == "char" || d.words == "cell" || d.words == "function_handle") return false;
        constexpr unsigned integer = 0, floating = 1, enumeration = 8;
        const bool whole = (d.type == integer || d.type == enumeration) &&
                           (d.size == 1 || d.size == 2 || d.size == 4 || d.size == 8);
        return whole || (d.type == floating && (d.size == 4 || d.size == 8) && d.precision == 8 * d.size);
    }

    void read_dataset(const dataset& d, const std::string& name) {
        if (!holds_numbers(d) || d.dimensions.empty()) return;
        std::uint64_t count = 1;
        for (const auto n : d.dimensions) {
            if (n == 0) return;
            if (n > most_numbers / count)
                refuse(fmt::format("{}: holds more than {} million numbers", name, most_numbers >> 20));
            count *= n;
        }
        if (count < 2) return; // a single number
        numbers_ += count;
        if (numbers_ > most_numbers)
            refuse(fmt::format("holds more than {} million numbers", most_numbers >> 20));
        std::vector<std::uint64_t> large;
        for (const auto n : d.dimensions)
            if (n > 1) large.push_back(n);
        if (large.size() > 2) return; // an array of three dimensions is no table
        const std::string data = bytes_of(d, name, count);
        std::vector<double> values(static_cast<std::size_t>(count));
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = value(d, std::string_view(data).substr(k * d.size, d.size));
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
        for (const number_column& c : columns_)
            if (c.name == name) refuse(name + " stands in two groups: keep one log in the file");
        columns_.push_back({name, std::move(values)});
    }

    static double value(const dataset& d, std::string_view raw) {
        std::string turned;
        if (d.bits & 1) { // the large end first
            turned.assign(raw.rbegin(), raw.rend());
            raw = turned;
        }
        if (d.type == 1) {
            if (d.size == 8) return quadrant::detail::bits_as<double>(little<std::uint64_t>(raw));
            return static_cast<double>(quadrant::detail::bits_as<float>(little<std::uint32_t>(raw)));
        }
        const bool negative_too = (d.bits & 8) != 0 && d.type == 0;
        switch (d.size) {
        case 1:
            return negative_too ? static_cast<double>(little<std::int8_t>(raw))
                                : static_cast<double>(little<std::uint8_t>(raw));
        case 2:
            return negative_too ? static_cast<double>(little<std::int16_t>(raw))
                                : static_cast<double>(little<std::uint16_t>(raw));
        case 4:
            return negative_too ? static_cast<double>(little<std::int32_t>(raw))
                                : static_cast<double>(little<std::uint32_t>(raw));
        default:
            return negative_too ? static_cast<double>(little<std::int64_t>(raw))
                                : static_cast<double>(little<std::uint64_t>(raw));
        }
    }

    // --- where the numbers lie ---

    std::string bytes_of(const dataset& d, const std::string& name, std::uint64_t count) {
        const std::uint64_t whole = count * d.size;
        const std::string_view l = d.layout;
        if (l.size() < 2) refuse(name + ": has no layout");
        if (l[0] != 3) refuse(name + ": has the layout of newer files: write it with libver='earliest'");
        if (l[1] == 0) { // in the header itself
            if (l.size() < 4 || l.size() - 4 < whole) refuse(name + ": is shorter than it says");
            return std::string(l.substr(4, static_cast<std::size_t>(whole)));
        }
        if (l[1] == 1) {
            if (l.size() < 18) refuse(name + ": has no layout");
            const auto address = little<std::uint64_t>(l.substr(2));
            if (address == none) return std::string(static_cast<std::size_t>(whole), '\0'); // never written
            return std::string(part(place(address), whole));
        }
        return from_chunks(d, name, whole);
    }

    std::string from_chunks(const dataset& d, const std::string& name, std::uint64_t whole) {
        const std::string_view l = d.layout;
        const std::size_t rank = d.dimensions.size();
        if (l.size() < 3 || static_cast<unsigned char>(l[2]) != rank + 1 || l.size() < 11 + 4 * (rank + 1))
            refuse(name + ": has no layout");
        std::vector<std::uint64_t> chunk;
        std::uint64_t size = d.size;
        for (std::size_t k = 0; k < rank; ++k) {
            chunk.push_back(little<std::uint32_t>(l.substr(11 + 4 * k)));
            if (chunk.back() == 0 || chunk.back() > (most_numbers * 8) / size)
                refuse(name + ": has chunks that are none");
            size *= chunk.back();
        }
        std::string out(static_cast<std::size_t>(whole), '\0');
        const auto address = little<std::uint64_t>(l.substr(3));
        if (address == none) return out;
        const auto steps = filters_of(d, name);
        std::uint64_t unpacked = 0;
        for_each_leaf(place(address), 1, 8 + 8 * (rank + 1), 0, [&](std::uint64_t key, std::uint64_t child) {
            const auto stored = number<std::uint32_t>(key), left_out = number<std::uint32_t>(key + 4);
            std::vector<std::uint64_t> corner;
            for (std::size_t k = 0; k < rank; ++k) corner.push_back(number<std::uint64_t>(key + 8 + 8 * k));
            unpacked += size;
            if (unpacked > 16 * (whole + size)) refuse(name + ": has more chunks than numbers");
            std::string data(part(place(child), stored));
            for (std::size_t f = steps.size(); f-- > 0;)
                if (!(left_out >> f & 1)) undo(steps[f], data, static_cast<std::size_t>(size), d.size, name);
            if (data.size() < size) refuse(name + ": a chunk is shorter than it says");
            put(d, chunk, corner, data, out);
        });
        return out;
    }

    /// The ids of the filters, in the order in which they were applied.
    std::vector<unsigned> filters_of(const dataset& d, const std::string& name) const {
        std::vector<unsigned> out;
        const std::string_view f = d.filters;
        if (f.empty()) return out;
        const unsigned version = static_cast<unsigned char>(f[0]),
                       count = f.size() > 1 ? static_cast<unsigned char>(f[1]) : 0;
        std::size_t at = version == 1 ? 8 : 2;
        for (unsigned k = 0; k < count; ++k) {
            if (f.size() < at + 8) refuse(name + ": its filters are damaged");
            const unsigned id = little<std::uint16_t>(f.substr(at));
            const bool named = version == 1 || id >= 256;
            const std::size_t words = named ? little<std::uint16_t>(f.substr(at + 2)) : 0,
                              values = little<std::uint16_t>(f.substr(at + (named ? 6 : 4)));
            at += (named ? 8 : 6) + (version == 1 ? (words + 7) / 8 * 8 : words) + 4 * values;
            if (version == 1 && values % 2 == 1) at += 4;
            if (id < 1 || id > 3)
                refuse(fmt::format("{}: is packed by filter {}; deflate (gzip), shuffle and checksums are read",
                                   name, id));
            out.push_back(id);
        }
        return out;
    }

    void undo(unsigned filter, std::string& data, std::size_t size, std::size_t each,
              const std::string& name) const {
        if (filter == 1) {
            if (data.size() < 6) refuse(name + ": a chunk is shorter than it says");
            inflation out = inflated(std::string_view(data).substr(2), size + 4);
            if (!out.whole) refuse(name + ": a chunk cannot be unpacked");
            data = std::move(out.text);
        } else if (filter == 2) { // first all first bytes, then all second ones, ...
            const std::size_t n = data.size() / each;
            std::string together(data.size(), '\0');
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t b = 0; b < each; ++b) together[k * each + b] = data[b * n + k];
            for (std::size_t k = n * each; k < data.size(); ++k) together[k] = data[k];
            data = std::move(together);
        } else if (data.size() >= 4) {
            data.resize(data.size() - 4);
        }
    }

    /// A chunk into its place; what hangs over the edge is dropped.
    static void put(const dataset& d, const std::vector<std::uint64_t>& chunk,
                    const std::vector<std::uint64_t>& corner, const std::string& data, std::string& out) {
        const std::size_t rank = chunk.size();
        std::vector<std::uint64_t> at(rank, 0);
        for (std::size_t k = 0; k < rank; ++k)
            if (corner[k] >= d.dimensions[k]) return;
        const std::uint64_t run = std::min(chunk[rank - 1], d.dimensions[rank - 1] - corner[rank - 1]);
        for (;;) {
            std::uint64_t from = 0, to = 0;
            bool inside = true;
            for (std::size_t k = 0; k < rank; ++k) {
                from = from * chunk[k] + at[k];
                to = to * d.dimensions[k] + corner[k] + at[k];
                inside = inside && corner[k] + at[k] < d.dimensions[k];
            }
            if (inside)
                std::memcpy(out.data() + to * d.size, data.data() + from * d.size,
                            static_cast<std::size_t>(run * d.size));
            std::size_t k = rank - 1; // the last dimension goes in one piece
            for (;;) {
                if (k == 0) return;
                --k;
                if (++at[k] < chunk[k]) break;
                at[k] = 0;
            }
        }
    }

    std::string_view file_, bytes_;
    std::uint64_t base_ = 0, numbers_ = 0;
    bool matlab_ = false;
    std::set<std::uint64_t> seen_{};
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
