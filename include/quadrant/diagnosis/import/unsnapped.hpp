// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// The text of a raw snappy stream, which has to be `whole` bytes long. `refuse(why)` does not come back.
template <class Refuse> std::string unsnapped(std::string_view from, std::size_t whole, const Refuse& refuse) {
    std::size_t at = 0;
    const auto next = [&] {
        if (at >= from.size()) refuse("a snappy stream is broken");
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
        if (shift > 28) refuse("a snappy stream is broken");
        size |= (b & 0x7f) << shift;
        if (b < 0x80) break;
    }
    if (size != whole) refuse("a snappy stream has another length than it states");
    std::string out;
    out.reserve(size);
    while (at < from.size()) {
        const std::size_t tag = next(), kind = tag & 3;
        std::size_t length = tag >> 2, back = 0;
        if (kind == 0) {
            if (length >= 60) length = little(length - 59);
            ++length;
            if (length > from.size() - at || out.size() + length > size) refuse("a snappy stream is broken");
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
        if (back == 0 || back > out.size() || out.size() + length > size) refuse("a snappy stream is broken");
        for (std::size_t k = 0; k < length; ++k) out += out[out.size() - back]; // they may overlap
    }
    if (out.size() != size) refuse("a snappy stream is broken");
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
