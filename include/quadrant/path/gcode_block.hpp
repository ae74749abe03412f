// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "program_text.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

namespace quadrant::inline v0::path::detail {

/// A letter and its number.
struct gcode_word {
    bool given = false;
    double value = 0;   ///< of a G word ten times its number: 611 is G61.1
    std::size_t at = 0; ///< byte of the line
};

/// One line of a G-code program: each letter once, one G word of each modal group (their numbers as in
/// [Kramer2000]).
struct gcode_block {
    enum group {
        non_modal = 0,
        motion = 1,
        plane = 2,
        distance_mode = 3,
        arc_distance = 4,
        feed_mode = 5,
        units = 6,
        radius_offset = 7,
        length_offset = 8,
        work_offset = 12,
        path_control = 13,
        groups = 14
    };

    std::array<gcode_word, 26> words{};
    std::array<gcode_word, groups> modes{};
    bool stop = false;    ///< M0 M1 M6
    bool end = false;     ///< M2 M30
    bool percent = false; ///< % alone
    bool empty = true;    ///< or comments alone

    const gcode_word& operator[](char letter) const { return words[std::size_t(letter - 'A')]; }
    gcode_word& operator[](char letter) { return words[std::size_t(letter - 'A')]; }
    const gcode_word& operator[](group of) const { return modes[std::size_t(of)]; }
};

/// Takes the line that was read last to pieces. Fails for what is no G-code and for what is not supported.
class gcode_parser {
public:
    explicit gcode_parser(const program_lines& lines) : lines_(lines) {}

    gcode_block block() const {
        gcode_block b;
        std::size_t at = skip_blanks(0);
        if (at < text().size() && text()[at] == '%') {
            if (skip_blanks(at + 1) != text().size()) lines_.fail(at, "% stands alone on its line");
            b.percent = true, b.empty = false;
            return b;
        }
        while ((at = skip_blanks(at)) < text().size() && text()[at] != ';') {
            if (text()[at] == '(') {
                at = behind_comment(at);
                continue;
            }
            b.empty = false;
            add(b, at);
        }
        return b;
    }

private:
    struct known_mode {
        int tenths;
        gcode_block::group group;
    };
    static constexpr std::array<known_mode, 19> known{{
        {0, gcode_block::motion},          {10, gcode_block::motion},         {20, gcode_block::motion},
        {30, gcode_block::motion},         {800, gcode_block::motion},        {40, gcode_block::non_modal},
        {170, gcode_block::plane},         {200, gcode_block::units},         {210, gcode_block::units},
        {400, gcode_block::radius_offset}, {490, gcode_block::length_offset}, {540, gcode_block::work_offset},
        {610, gcode_block::path_control},  {611, gcode_block::path_control},  {640, gcode_block::path_control},
        {900, gcode_block::distance_mode}, {910, gcode_block::distance_mode}, {911, gcode_block::arc_distance},
        {940, gcode_block::feed_mode},
    }};

    std::string_view text() const { return lines_.text(); }
    std::size_t skip_blanks(std::size_t at) const {
        while (at < text().size() && is_blank(text()[at])) ++at;
        return at;
    }
    std::size_t behind_comment(std::size_t from) const {
        const std::size_t end = text().find(')', from);
        if (end == std::string_view::npos) lines_.fail(from, "the comment has no end");
        if (text().substr(from + 1, end - from - 1).find('(') != std::string_view::npos)
            lines_.fail(from, "a comment inside a comment");
        return end + 1;
    }
    void refuse_expression(std::size_t at) const {
        if (at < text().size() && (text()[at] == '#' || text()[at] == '['))
            lines_.fail(at, "parameters and expressions are not supported");
    }

    /// The word that begins at `at`, which then is behind it.
    void add(gcode_block& b, std::size_t& at) const {
        const std::size_t from = at;
        const char letter = upper(text()[at]);
        refuse_expression(at);
        if (letter == '/') lines_.fail(from, "optional blocks (/) are not supported");
        if (!is_letter(letter))
            lines_.fail(from, joined({in_quotes(text().substr(from, 1)), " does not begin a word"}));
        at = skip_blanks(at + 1);
        refuse_expression(at);
        const gcode_word w{true, lines_.fixed_number(at), from};
        const auto refuse = [&](std::string_view why) {
            lines_.fail(from, joined({in_quotes(text().substr(from, at - from)), why}));
        };
        gcode_word* place = nullptr;
        if (letter == 'M') {
            constexpr std::string_view no_effect = "345789", stops = "016";
            const bool digit = w.value == std::floor(w.value) && w.value >= 0 && w.value < 10;
            const char name = digit ? char('0' + int(w.value)) : ' ';
            if (stops.find(name) != std::string_view::npos)
                b.stop = true;
            else if (w.value == 2 || w.value == 30)
                b.end = true;
            else if (no_effect.find(name) == std::string_view::npos)
                refuse(" is not supported");
            return;
        }
        if (letter == 'G') {
            for (const auto& [tenths, group] : known)
                if (std::abs(10 * w.value - tenths) < 1e-6) place = &b.modes[std::size_t(group)];
            if (place == nullptr) refuse(" is not supported");
            if (place->given) refuse(": another word of its group stands in the block");
            *place = {true, std::round(10 * w.value), from};
            return;
        }
        if (std::string_view("FIJNOPRSTXYZ").find(letter) == std::string_view::npos)
            refuse(" is not supported");
        if (b[letter].given) refuse(": the letter occurs twice in the block");
        if (std::string_view("FNOPST").find(letter) != std::string_view::npos && w.value < 0)
            refuse(": must not be below 0");
        b[letter] = w;
    }

    const program_lines& lines_;
};

} // namespace quadrant::inline v0::path::detail
