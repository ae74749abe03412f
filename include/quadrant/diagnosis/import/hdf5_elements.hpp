// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "hdf5_bytes.hpp"
#include "hdf5_dataset.hpp"
#include "inflated.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// The bytes of the elements of a dataset: in its header, in one piece or in chunks, which may have gone
/// through filters.
class hdf5_elements {
public:
    explicit hdf5_elements(const hdf5_bytes& file) : file_(file) {}

    /// Those of `count` elements; `name`: of the dataset, for a refusal.
    // --- where the numbers lie ---

    std::string bytes_of(const hdf5_dataset& d, const std::string& name, std::uint64_t count) const {
        const std::uint64_t whole = count * d.size;
        const std::string_view l = d.layout;
        if (l.size() < 2) file_.refuse(name + ": has no layout");
        if (l[0] != 3) file_.refuse(name + ": has the layout of newer files: write it with libver='earliest'");
        if (l[1] == 0) { // in the header itself
            if (l.size() < 4 || l.size() - 4 < whole)
                file_.refuse(name + ": holds less data than its header states");
            return std::string(l.substr(4, static_cast<std::size_t>(whole)));
        }
        if (l[1] == 1) {
            if (l.size() < 18) file_.refuse(name + ": has no layout");
            const auto address = little_endian<std::uint64_t>(l.substr(2));
            if (address == hdf5_bytes::nowhere)
                return std::string(static_cast<std::size_t>(whole), '\0'); // never written
            return std::string(file_.part(file_.place(address), whole));
        }
        return from_chunks(d, name, whole);
    }

private:
    std::string from_chunks(const hdf5_dataset& d, const std::string& name, std::uint64_t whole) const {
        const std::string_view l = d.layout;
        const std::size_t rank = d.dimensions.size();
        if (l.size() < 3 || static_cast<unsigned char>(l[2]) != rank + 1 || l.size() < 11 + 4 * (rank + 1))
            file_.refuse(name + ": has no layout");
        std::vector<std::uint64_t> chunk;
        std::uint64_t size = d.size;
        for (std::size_t k = 0; k < rank; ++k) {
            chunk.push_back(little_endian<std::uint32_t>(l.substr(11 + 4 * k)));
            if (chunk.back() == 0 || chunk.back() > (hdf5_bytes::most_numbers * 8) / size)
                file_.refuse(name + ": its list of chunks is damaged");
            size *= chunk.back();
        }
        std::string out(static_cast<std::size_t>(whole), '\0');
        const auto address = little_endian<std::uint64_t>(l.substr(3));
        if (address == hdf5_bytes::nowhere) return out;
        const auto steps = filters_of(d, name);
        std::uint64_t unpacked = 0;
        file_.for_each_leaf(file_.place(address), 1, 8 + 8 * (rank + 1), 0,
                            [&](std::uint64_t key, std::uint64_t child) {
                                const auto stored = file_.number<std::uint32_t>(key),
                                           left_out = file_.number<std::uint32_t>(key + 4);
                                std::vector<std::uint64_t> corner;
                                for (std::size_t k = 0; k < rank; ++k)
                                    corner.push_back(file_.number<std::uint64_t>(key + 8 + 8 * k));
                                unpacked += size;
                                if (unpacked > 16 * (whole + size))
                                    file_.refuse(name + ": has more chunks than numbers");
                                std::string data(file_.part(file_.place(child), stored));
                                for (std::size_t f = steps.size(); f-- > 0;)
                                    if (!(left_out >> f & 1))
                                        undo(steps[f], data, static_cast<std::size_t>(size), d.size, name);
                                if (data.size() < size)
                                    file_.refuse(name + ": a chunk holds less data than it states");
                                put(d, chunk, corner, data, out);
                            });
        return out;
    }

    /// The ids of the filters, in the order in which they were applied.
    std::vector<unsigned> filters_of(const hdf5_dataset& d, const std::string& name) const {
        std::vector<unsigned> out;
        const std::string_view f = d.filters;
        if (f.empty()) return out;
        const unsigned version = static_cast<unsigned char>(f[0]),
                       count = f.size() > 1 ? static_cast<unsigned char>(f[1]) : 0;
        std::size_t at = version == 1 ? 8 : 2;
        for (unsigned k = 0; k < count; ++k) {
            if (f.size() < at + 8) file_.refuse(name + ": its filters are damaged");
            const unsigned id = little_endian<std::uint16_t>(f.substr(at));
            const bool named = version == 1 || id >= 256;
            const std::size_t words = named ? little_endian<std::uint16_t>(f.substr(at + 2)) : 0,
                              values = little_endian<std::uint16_t>(f.substr(at + (named ? 6 : 4)));
            at += (named ? 8 : 6) + (version == 1 ? (words + 7) / 8 * 8 : words) + 4 * values;
            if (version == 1 && values % 2 == 1) at += 4;
            if (id < 1 || id > 3)
                file_.refuse(fmt::format(
                    "{}: is packed by filter {}; deflate (gzip), shuffle and checksums are read", name, id));
            out.push_back(id);
        }
        return out;
    }

    void undo(unsigned filter, std::string& data, std::size_t size, std::size_t each,
              const std::string& name) const {
        if (filter == 1) {
            if (data.size() < 6) file_.refuse(name + ": a chunk holds less data than it states");
            inflation out = inflated(std::string_view(data).substr(2), size + 4);
            if (!out.whole) file_.refuse(name + ": a chunk cannot be unpacked");
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
    static void put(const hdf5_dataset& d, const std::vector<std::uint64_t>& chunk,
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

    const hdf5_bytes& file_;
};

} // namespace quadrant::inline v0::diagnosis::detail
