// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Bytes of the printable UTF-8 character that `text` begins with; 0: a control character, or not UTF-8.
inline std::size_t printable_bytes(std::string_view text) {
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const unsigned first = byte(0), second = byte(1);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t n = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    for (std::size_t k = 1; k < n; ++k)
        if ((byte(k) & 0xc0) != 0x80) return 0;
    const bool control = first == 0xc2 && second < 0xa0;
    const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
    const bool no_character = (first == 0xed && second >= 0xa0) || (first == 0xf4 && second >= 0x90);
    return control || overlong || no_character ? 0 : n;
}

/// Fit for one line of a terminal and for JSON: what comes from a file may hold anything, and any amount of it.
inline std::string one_line(std::string_view text, std::size_t longest = 4096) {
    std::string out;
    while (!text.empty()) {
        const std::size_t n = printable_bytes(text);
        if (out.size() + n > longest) return out + "...";
        out += n == 0 ? std::string_view("?") : text.substr(0, n);
        text.remove_prefix(n == 0 ? 1 : n);
    }
    return out;
}

/// A piece of a file as a message shows it.
inline std::string in_quotes(std::string_view text) { return '"' + one_line(text, 40) + '"'; }

} // namespace detail

/// A file that cannot be used. what() is one line: "FILE:LINE:COLUMN: message", or "FILE: message" where no
/// single place is at fault. Line and column count from 1, the column in characters.
struct bad_input : std::runtime_error {
    bad_input(std::string_view file, std::string_view message)
        : std::runtime_error(fmt::format("{}: {}", detail::one_line(file), detail::one_line(message, 400))) {}
    bad_input(std::string_view file, std::size_t line, std::size_t column, std::string_view message)
        : std::runtime_error(fmt::format("{}:{}:{}: {}", detail::one_line(file), line, column,
                                         detail::one_line(message, 400))) {}
};

} // namespace quadrant::inline v0::diagnosis
