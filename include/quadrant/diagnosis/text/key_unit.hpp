// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// A key in two parts: what it is called and its unit, as keys are written. "stribeck_velocity_m_per_s" is
/// {"stribeck_velocity", "m_per_s"}; a pure number has no unit.
struct key_parts {
    std::string_view stem, unit;
};

/// Splits a key before the longest run of unit words at its end. A word of a unit may have a digit, its
/// exponent.
constexpr key_parts parts_of(std::string_view key) {
    constexpr std::array<std::string_view, 10> words{"V", "A", "N", "Nm", "m", "rad", "s", "kg", "Hz", "per"};
    std::size_t end = key.size(); // of the stem
    while (true) {
        const std::string_view rest = key.substr(0, end);
        const std::size_t bar = rest.find_last_of("_.");
        if (bar == rest.npos || rest[bar] == '.') break;
        std::string_view word = rest.substr(bar + 1);
        if (word.size() > 1 && word.back() >= '2' && word.back() <= '9') word.remove_suffix(1);
        if (std::find(words.begin(), words.end(), word) == words.end()) break;
        end = bar;
    }
    return {key.substr(0, end), end < key.size() ? key.substr(end + 1) : std::string_view()};
}

/// A unit as texts have it: "N_s2_per_m2" is "N s²/m²", "per_s" is "1/s".
inline std::string unit_text(std::string_view unit) {
    std::string out;
    bool begins = true; // nothing stands before, or a stroke
    while (!unit.empty()) {
        const std::size_t bar = std::min(unit.find('_'), unit.size());
        const std::string_view word = unit.substr(0, bar);
        unit.remove_prefix(std::min(bar + 1, unit.size()));
        if (word == "per") {
            out += out.empty() ? "1/" : "/";
            begins = true;
            continue;
        }
        if (!begins) out += ' ';
        begins = false;
        if (word == "Nm")
            out += "N m";
        else if (word.back() == '2')
            out.append(word.substr(0, word.size() - 1)).append("\u00b2");
        else if (word.back() == '3')
            out.append(word.substr(0, word.size() - 1)).append("\u00b3");
        else
            out += word;
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
