// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "text.hpp"

#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Line and column, from 1, of the key at a dotted path of a JSON text that parses; {0, 0} when it is written
/// with escapes.
inline std::pair<std::size_t, std::size_t> key_place(std::string_view text, std::string_view path) {
    std::vector<std::string> open;
    const auto here = [&] {
        std::string out;
        for (const auto& key : open)
            if (!key.empty()) out += (out.empty() ? "" : ".") + key;
        return out;
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '{' || text[i] == '[') open.emplace_back();
        if ((text[i] == '}' || text[i] == ']') && !open.empty()) open.pop_back();
        if (text[i] != '"') continue;
        const std::size_t begin = i++;
        while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
        const std::size_t next = text.find_first_not_of(" \t\r\n", std::min(i + 1, text.size()));
        if (next == text.npos || text[next] != ':' || open.empty()) continue;
        open.back() = std::string(text.substr(begin + 1, i - begin - 1));
        if (here() != path) continue;
        const std::string_view before = text.substr(0, begin);
        return {static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1,
                characters(before.substr(before.find_last_of('\n') + 1)) + 1};
    }
    return {0, 0};
}

} // namespace quadrant::inline v0::diagnosis::detail
