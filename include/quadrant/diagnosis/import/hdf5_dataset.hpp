// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/portable.hpp"
#include "hdf5_bytes.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// What the header of a dataset in an HDF5 file says: shape, type of an element, and where its bytes are. The
/// messages of the header fill it in, in any order.
struct hdf5_dataset {
    std::vector<std::uint64_t> dimensions{};
    bool has_space = false;
    unsigned type = 0, bits = 0, size = 0; ///< class, bit field and bytes of an element
    unsigned precision = 0;
    std::string_view layout{}, filters{};
    std::string words{}; ///< of MATLAB_class

    void space(std::string_view m) {
        if (m.size() < 4) return;
        const auto version = static_cast<unsigned char>(m[0]), rank = static_cast<unsigned char>(m[1]);
        const std::size_t from = version == 1 ? 8 : 4;
        if (rank > 32 || m.size() < from + 8 * std::size_t{rank}) return;
        for (std::size_t k = 0; k < rank; ++k)
            dimensions.push_back(little_endian<std::uint64_t>(m.substr(from + 8 * k)));
        has_space = true;
    }
    /// The type of an element; false where the message is too short to hold one.
    bool element(std::string_view m) {
        if (m.size() < 8) return false;
        type = static_cast<unsigned char>(m[0]) & 0x0f;
        bits = little_endian<std::uint32_t>(m) >> 8;
        size = little_endian<std::uint32_t>(m.substr(4));
        precision = m.size() >= 12 ? little_endian<std::uint16_t>(m.substr(10)) : 0;
        return true;
    }
    void attribute(std::string_view m) {
        if (m.size() < 8) return;
        const unsigned version = static_cast<unsigned char>(m[0]);
        const auto aligned = [&](std::size_t n) { return version == 1 ? (n + 7) / 8 * 8 : n; };
        const std::size_t name = little_endian<std::uint16_t>(m.substr(2)),
                          of_type = little_endian<std::uint16_t>(m.substr(4)),
                          of_space = little_endian<std::uint16_t>(m.substr(6)), from = version == 3 ? 9 : 8,
                          data = from + aligned(name) + aligned(of_type) + aligned(of_space);
        if (m.size() < data || m.substr(from, name).find("MATLAB_class") != 0) return;
        words = m.substr(data);
        if (const auto end = words.find('\0'); end != words.npos) words.resize(end);
    }

    bool holds_numbers() const {
        if (words == "char" || words == "cell" || words == "function_handle") return false;
        constexpr unsigned integer = 0, floating = 1, enumeration = 8;
        const bool whole =
            (type == integer || type == enumeration) && (size == 1 || size == 2 || size == 4 || size == 8);
        return whole || (type == floating && (size == 4 || size == 8) && precision == 8 * size);
    }
    /// One element.
    double value(std::string_view raw) const {
        std::string turned;
        if (bits & 1) { // the large end first
            turned.assign(raw.rbegin(), raw.rend());
            raw = turned;
        }
        if (type == 1) {
            if (size == 8) return quadrant::detail::bits_as<double>(little_endian<std::uint64_t>(raw));
            return static_cast<double>(quadrant::detail::bits_as<float>(little_endian<std::uint32_t>(raw)));
        }
        const bool negative_too = (bits & 8) != 0 && type == 0;
        switch (size) {
        case 1:
            return negative_too ? static_cast<double>(little_endian<std::int8_t>(raw))
                                : static_cast<double>(little_endian<std::uint8_t>(raw));
        case 2:
            return negative_too ? static_cast<double>(little_endian<std::int16_t>(raw))
                                : static_cast<double>(little_endian<std::uint16_t>(raw));
        case 4:
            return negative_too ? static_cast<double>(little_endian<std::int32_t>(raw))
                                : static_cast<double>(little_endian<std::uint32_t>(raw));
        default:
            return negative_too ? static_cast<double>(little_endian<std::int64_t>(raw))
                                : static_cast<double>(little_endian<std::uint64_t>(raw));
        }
    }
};

} // namespace quadrant::inline v0::diagnosis::detail
