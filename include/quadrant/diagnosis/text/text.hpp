// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "bad_input.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <istream>

namespace quadrant::inline v0::diagnosis::detail {

/// A text of 16-bit units (UTF-16 with its byte order mark, as Windows programs export) in UTF-8; any other as
/// it is.
inline std::string in_utf8(std::string text) {
    const bool little = text.starts_with("\xFF\xFE"), big = text.starts_with("\xFE\xFF");
    if (!little && !big) return text;
    const auto unit = [&](std::size_t at) {
        const auto low = static_cast<unsigned char>(text[little ? at : at + 1]);
        const auto high = static_cast<unsigned char>(text[little ? at + 1 : at]);
        return static_cast<unsigned>(high) * 256 + low;
    };
    std::string out;
    out.reserve(text.size() / 2);
    const auto tail = [&](unsigned bits) { out += static_cast<char>(0x80 | (bits & 0x3f)); };
    for (std::size_t at = 2; at + 1 < text.size(); at += 2) {
        unsigned c = unit(at);
        const bool pair = c >= 0xd800 && c < 0xdc00 && at + 3 < text.size() && unit(at + 2) >= 0xdc00 &&
                          unit(at + 2) < 0xe000;
        if (pair) {
            c = 0x10000 + (c - 0xd800) * 0x400 + (unit(at + 2) - 0xdc00);
            at += 2;
        } else if (c >= 0xd800 && c < 0xe000) {
            c = 0xfffd; // half of a pair
        }
        if (c < 0x80) {
            out += static_cast<char>(c);
        } else if (c < 0x800) {
            out += static_cast<char>(0xc0 | (c >> 6));
            tail(c);
        } else if (c < 0x10000) {
            out += static_cast<char>(0xe0 | (c >> 12));
            tail(c >> 6);
            tail(c);
        } else {
            out += static_cast<char>(0xf0 | (c >> 18));
            tail(c >> 12);
            tail(c >> 6);
            tail(c);
        }
    }
    return out;
}

inline std::string read_whole(std::istream& in, std::string_view name) {
    std::string text;
    std::array<char, 1 << 16> chunk{};
    do {
        in.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
        text.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
    } while (in);
    if (!in.eof()) throw bad_input(name, "cannot be read");
    return in_utf8(std::move(text));
}

inline std::string read_whole(const std::filesystem::path& path) {
    std::error_code fault;
    const auto status = std::filesystem::status(path, fault);
    if (!std::filesystem::exists(status)) throw bad_input(path.string(), "no such file");
    if (std::filesystem::is_directory(status)) throw bad_input(path.string(), "is a directory");
    std::ifstream in(path, std::ios::binary);
    if (!in) throw bad_input(path.string(), "cannot be opened");
    return read_whole(in, path.string());
}

inline std::string_view without_byte_order_mark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

inline std::size_t characters(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

} // namespace quadrant::inline v0::diagnosis::detail
