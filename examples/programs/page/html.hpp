// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <fmt/format.h>
#include <span>
#include <string>
#include <string_view>

/// What the pages of quadrant-gap and quadrant-reproduce have in common: HTML files that need no network.
namespace quadrant_page {

inline void replace_all(std::string& text, std::string_view what, std::string_view with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
        text.replace(at, what.size(), with);
}

/// Text as HTML, also between quotes.
inline std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text)
        if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '>')
            safe += "&gt;";
        else if (c == '"')
            safe += "&quot;";
        else if (c == '\'')
            safe += "&#39;";
        else
            safe += c;
    return safe;
}

/// A file that embed.cmake has cut into pieces.
inline std::string joined(std::span<const std::string_view> pieces) {
    std::string text;
    for (const std::string_view p : pieces) text += p;
    return text;
}

/// A page without scripts: what is in its head, and what follows.
inline std::string document(std::string_view title, std::string_view style, std::string_view body) {
    return fmt::format("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                       "<meta name=\"color-scheme\" content=\"light dark\">\n"
                       "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
                       "'unsafe-inline'\">\n"
                       "<title>{}</title>\n<style>\n{}\n</style>\n</head>\n<body>\n{}</body>\n</html>\n",
                       title, style, body);
}

} // namespace quadrant_page
