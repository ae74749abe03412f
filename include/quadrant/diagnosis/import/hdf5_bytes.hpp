// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/bad_input.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// A number of as many bytes as it has, the small end first.
template <class T> T little_endian(std::string_view from) {
    std::uint64_t out = 0;
    for (std::size_t k = 0; k < sizeof(T); ++k)
        out |= static_cast<std::uint64_t>(static_cast<unsigned char>(from[k])) << (8 * k);
    return static_cast<T>(out);
}

/// The bytes of an HDF5 file by their addresses. What lies outside is refused with its place.
class hdf5_bytes {
public:
    static constexpr std::uint64_t nowhere = ~std::uint64_t{0}; ///< the address of what was never written
    static constexpr std::uint64_t most_numbers = std::uint64_t{1} << 25; ///< of one file
    static constexpr int deepest = 16; ///< of groups in groups, trees in trees

    hdf5_bytes(std::string_view bytes, std::string_view file) : file_(file), bytes_(bytes) {}

    /// The signature stands at 0, 512, 1024, 2048, ...
    static std::size_t begin_of(std::string_view bytes) {
        for (std::size_t at = 0; at + 96 <= bytes.size(); at = at == 0 ? 512 : 2 * at)
            if (bytes.substr(at, signature.size()) == signature) return at;
        return bytes.npos;
    }

    /// Addresses count from here.
    void base(std::uint64_t at) { base_ = at; }
    bool begins_with(std::string_view word) const { return bytes_.starts_with(word); }

    [[noreturn]] void refuse(const std::string& why) const { throw bad_input(file_, why); }
    [[noreturn]] void damaged(std::uint64_t at) const {
        refuse(fmt::format("byte {}: the file is damaged", at));
    }

    template <class T> T number(std::uint64_t at) const {
        if (bytes_.size() < sizeof(T) || at > bytes_.size() - sizeof(T))
            damaged(std::min<std::uint64_t>(at, bytes_.size()));
        return little_endian<T>(bytes_.substr(static_cast<std::size_t>(at), sizeof(T)));
    }
    std::uint64_t place(std::uint64_t address) const {
        const std::uint64_t at = address + base_;
        if (address == nowhere || at < address || at >= bytes_.size())
            damaged(std::min<std::uint64_t>(at, bytes_.size()));
        return at;
    }
    std::string_view part(std::uint64_t at, std::uint64_t size) const {
        if (at > bytes_.size() || size > bytes_.size() - at)
            damaged(std::min<std::uint64_t>(at, bytes_.size()));
        return bytes_.substr(static_cast<std::size_t>(at), static_cast<std::size_t>(size));
    }
    bool is(std::uint64_t at, std::string_view word) const { return part(at, word.size()) == word; }

    /// Calls leaf(place of the key, address of the child) for every child of the lowest level of a B-tree.
    template <class Leaf>
    void for_each_leaf(std::uint64_t node, unsigned kind, std::uint64_t key, int depth,
                       const Leaf& leaf) const {
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

private:
    static constexpr std::string_view signature{"\x89HDF\r\n\x1a\n", 8};

    std::string_view file_, bytes_;
    std::uint64_t base_ = 0;
};

} // namespace quadrant::inline v0::diagnosis::detail
