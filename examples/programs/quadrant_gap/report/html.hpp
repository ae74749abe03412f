// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../page/html.hpp"

#include <filesystem>
#include <map>

/// Text of a report as HTML, and its template. User strings go through escape(); the chart data holds none.
namespace quadrant_gap {

using quadrant_page::joined;

/// Text as HTML; a number and its unit stay on one line.
inline std::string escape(std::string_view text) {
    std::string safe = quadrant_page::escaped(text);
    for (std::size_t at = 1; at < safe.size(); ++at)
        if (safe[at] == ' ' && safe[at - 1] >= '0' && safe[at - 1] <= '9') safe.replace(at, 1, "&nbsp;");
    return safe;
}

/// The last part of a path, for a title; what is no path stays as it is.
inline std::string file_name(const std::string& path) {
    const std::string name = std::filesystem::path(path).filename().string();
    return name.empty() ? path : name;
}

/// Replaces each {{name}} of the template; what is filled in is not searched again.
inline std::string fill(std::string_view text, const std::map<std::string_view, std::string>& values) {
    std::string out;
    for (std::size_t open; (open = text.find("{{")) != std::string_view::npos;) {
        const std::size_t close = text.find("}}", open);
        out += text.substr(0, open);
        out += values.at(text.substr(open + 2, close - open - 2));
        text.remove_prefix(close + 2);
    }
    return out.append(text);
}

} // namespace quadrant_gap
