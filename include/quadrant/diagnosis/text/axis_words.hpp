// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// A linear axis has a mass, forces and metres, a rotary one an inertia, torques and radians. The mathematics
/// is one: inside the diagnosis every axis has the linear names, and what a file, a message or a page shows is
/// put into its own words.
enum class axis_kind { linear, rotary };

constexpr const char* name_of(axis_kind k) { return k == axis_kind::rotary ? "rotary" : "linear"; }

/// One word of a linear axis, in a key (between `_` and `.`) and in a text, and what a rotary axis says for it.
struct axis_word {
    std::string_view linear, in_key, in_text;
};
inline constexpr std::array axis_words{
    axis_word{"m", "rad", "rad"},
    axis_word{"N", "Nm", "N m"},
    axis_word{"kg", "kg_m2", "kg m2"},
    axis_word{"mass", "inertia", "inertia"},
    axis_word{"force", "torque", "torque"},
    axis_word{"length", "angle", "angle"},
    axis_word{"Force", "", "Torque"},
    axis_word{"forces", "", "torques"},
    axis_word{"Forces", "", "Torques"},
    axis_word{"newtons", "", "newton metres"},
    axis_word{"mm", "", "mrad"},
    axis_word{"um", "", "urad"},
    axis_word{"\u00b5m", "", "\u00b5rad"},
    axis_word{"nm", "", "nrad"},
    axis_word{"kN", "", "kN m"},
    axis_word{"mN", "", "mN m"},
};

namespace detail {

/// The text with each word put through `say`; a word is a run of characters that are not `apart`.
template <class Apart, class Say> std::string by_word(std::string_view text, Apart apart, Say say) {
    std::string out;
    while (!text.empty()) {
        std::size_t n = 0;
        while (n < text.size() && !apart(text[n])) ++n;
        if (n > 0)
            out += say(text.substr(0, n));
        else
            out += text[n++];
        text.remove_prefix(n);
    }
    return out;
}

} // namespace detail

/// The key of a machine file or a diagnosis as an axis of this kind has it: velocity_gain_V_s_per_m is
/// velocity_gain_V_s_per_rad, mass_kg is inertia_kg_m2.
inline std::string key_of(std::string_view linear, axis_kind kind) {
    if (kind == axis_kind::linear) return std::string(linear);
    return detail::by_word(
        linear, [](char c) { return c == '_' || c == '.'; },
        [](std::string_view word) {
            const bool power = word.size() > 1 && word.back() >= '2' && word.back() <= '9'; // m2 is rad2
            const std::string_view base = power ? word.substr(0, word.size() - 1) : word;
            for (const axis_word& w : axis_words)
                if (w.linear == base && !w.in_key.empty())
                    return std::string(w.in_key) + (power ? std::string(1, word.back()) : "");
            return std::string(word);
        });
}

/// A text as an axis of this kind has it; effect names (constant_force) and the name of an axis stay.
inline std::string text_of(std::string_view linear, axis_kind kind) {
    if (kind == axis_kind::linear) return std::string(linear);
    std::string_view before;
    return detail::by_word(
        linear,
        [](char c) {
            const auto u = static_cast<unsigned char>(c);
            return u < 0x80 && c != '_' && !(c >= '0' && c <= '9') && !(c >= 'a' && c <= 'z') &&
                   !(c >= 'A' && c <= 'Z');
        },
        [&](std::string_view word) {
            const bool axis_name = before == "axis" || before == "Axis";
            before = word;
            for (const axis_word& w : axis_words)
                if (w.linear == word && !axis_name) return w.in_text;
            return word;
        });
}

/// The command of the axis is its force or torque itself: there is no constant between them.
inline bool is_force(std::string_view command_unit) { return command_unit == "N" || command_unit == "Nm"; }

/// Behind the column of a measured current, after this word: that of a torque, which a rotary axis may have.
inline std::string and_torque(std::string_view word, std::string_view axis, axis_kind kind) {
    return kind == axis_kind::rotary ? std::string(word).append(axis).append("_torque_Nm") : "";
}

} // namespace quadrant::inline v0::diagnosis
