// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/portable.hpp"
#include "parquet_column.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Runs and packed groups of eight, mixed: levels and indices.
inline std::vector<std::uint32_t> parquet_runs(const parquet_column& c, std::string_view from, unsigned width,
                                               std::size_t count) {
    std::vector<std::uint32_t> out;
    out.reserve(count);
    std::size_t at = 0;
    const std::size_t bytes = (width + 7) / 8;
    while (out.size() < count) {
        std::uint64_t head = 0;
        unsigned shift = 0;
        for (;; shift += 7) {
            if (at >= from.size() || shift > 35) c.refuse("a page is too short");
            const auto b = static_cast<unsigned char>(from[at++]);
            head |= static_cast<std::uint64_t>(b & 0x7f) << shift;
            if (!(b & 0x80)) break;
        }
        if (head & 1) {
            const std::uint64_t groups = head >> 1;
            if (groups == 0 || groups > parquet_column::most_bytes || groups * width > from.size() - at) {
                // The last group may be cut where no value needs it.
                if (groups == 0 || groups > parquet_column::most_bytes) c.refuse("a page is too short");
            }
            for (std::uint64_t k = 0; k < groups * 8 && out.size() < count; ++k) {
                std::uint64_t value = 0;
                const std::uint64_t bit = k * width;
                for (unsigned b = 0; b < width; ++b) {
                    const auto byte = at + static_cast<std::size_t>((bit + b) / 8);
                    if (byte >= from.size()) c.refuse("a page is too short");
                    value |= static_cast<std::uint64_t>(
                                 (static_cast<unsigned char>(from[byte]) >> ((bit + b) % 8)) & 1)
                             << b;
                }
                out.push_back(static_cast<std::uint32_t>(value));
            }
            at += static_cast<std::size_t>(std::min<std::uint64_t>(groups * width, from.size() - at));
        } else {
            const std::uint64_t times = head >> 1;
            if (times == 0 || bytes > from.size() - at) c.refuse("a page is too short");
            std::uint32_t value = 0;
            for (std::size_t b = 0; b < bytes; ++b)
                value |= static_cast<std::uint32_t>(static_cast<unsigned char>(from[at + b])) << (8 * b);
            at += bytes;
            for (std::uint64_t k = 0; k < times && out.size() < count; ++k) out.push_back(value);
        }
    }
    return out;
}

/// Values one after the other. Time stamps count from the first one of the file: a double does not hold
/// nanoseconds of 1970.
class parquet_plain_values {
public:
    std::vector<double> operator()(const parquet_column& c, std::string_view from, std::size_t count) {
        std::vector<double> out;
        const std::size_t each = c.type == parquet_column::int32 || c.type == parquet_column::of_float ? 4 : 8;
        if (from.size() < (c.type == parquet_column::boolean ? (count + 7) / 8 : count * each))
            c.refuse("a page is too short");
        out.reserve(count);
        for (std::size_t k = 0; k < count; ++k) {
            if (c.type == parquet_column::boolean) {
                out.push_back((static_cast<unsigned char>(from[k / 8]) >> (k % 8)) & 1);
                continue;
            }
            const std::uint64_t low = parquet_word(from, k * each),
                                high = each == 8 ? parquet_word(from, k * each + 4) : 0, raw = high << 32 | low;
            if (c.type == parquet_column::of_double)
                out.push_back(quadrant::detail::bits_as<double>(raw));
            else if (c.type == parquet_column::of_float)
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

private:
    std::optional<std::int64_t> epoch_{}; ///< near the time stamps
};

} // namespace quadrant::inline v0::diagnosis::detail
