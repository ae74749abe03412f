// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../bad_input.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <istream>

namespace quadrant::diagnosis::detail {

inline std::string read_whole(std::istream& in, std::string_view name) {
    std::string text;
    std::array<char, 1 << 16> chunk{};
    do {
        in.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
        text.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
    } while (in);
    if (!in.eof()) throw bad_input(name, "cannot be read");
    return text;
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

} // namespace quadrant::diagnosis::detail
