// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "move.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <deque>
#include <fstream>
#include <initializer_list>
#include <istream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace quadrant::inline v0::path {

/// A program that cannot be used. what() is one line: "FILE:LINE:COLUMN: message", or "FILE: message" where no
/// single place is at fault. Line and column count from 1, the column in characters.
struct bad_program : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What holds before the first line of a program.
struct program_start {
    point place{};                                ///< where the axes stand [m]
    path_ending ending = path_ending::exact_stop; ///< of moves, until the program says otherwise
    double tolerance = 0;                         ///< of a continuous ending [m]
};

namespace detail {

/// Fit for one line of a message: what comes from a file may hold anything, and any amount of it.
inline std::string shown(std::string_view text, std::size_t longest = 40) {
    std::string out(text.substr(0, longest));
    for (char& c : out)
        if (c < 0x20 || c > 0x7e) c = '?';
    return text.size() > longest ? out + "..." : out;
}
inline std::string joined(std::initializer_list<std::string_view> words) {
    std::string out;
    for (const std::string_view word : words) out += word;
    return out;
}
inline std::string in_quotes(std::string_view text) { return joined({"\"", shown(text), "\""}); }
/// Millimetres for a message.
inline std::string in_mm(double metres) { return joined({std::to_string(1e3 * metres), " mm"}); }

constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }
constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
constexpr char upper(char c) noexcept { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; }
constexpr bool is_letter(char c) noexcept { return upper(c) >= 'A' && upper(c) <= 'Z'; }

/// The lines of a file, one at a time, and where we are in it.
class program_lines {
public:
    static constexpr std::size_t longest = 4096;

    program_lines(std::istream& in, std::string_view name) : in_(in), name_(shown(name, 400)) {}

    /// False at the end of the file. The line ends without LF or CR LF.
    bool next() {
        text_.clear();
        constexpr int end = std::char_traits<char>::eof();
        int c = one();
        if (c == end) return false;
        ++number_;
        for (; c != end && c != '\n'; c = one()) {
            text_ += std::char_traits<char>::to_char_type(c);
            if (text_.size() > longest) fail(longest, "the line is longer than 4096 characters");
        }
        if (text_.ends_with('\r')) text_.pop_back();
        if (number_ == 1 && text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
        return true;
    }
    std::string_view text() const noexcept { return text_; }
    std::size_t number() const noexcept { return number_; }

    /// `at` counts bytes of the line from 0.
    std::size_t column(std::size_t at) const {
        std::size_t characters = 1;
        for (std::size_t i = 0; i < at && i < text_.size(); ++i)
            characters += (static_cast<unsigned char>(text_[i]) & 0xc0) != 0x80;
        return characters;
    }
    [[noreturn]] void fail(std::size_t at, std::string_view message) const {
        fail(number_, column(at), message);
    }
    [[noreturn]] void fail(std::size_t line, std::size_t column, std::string_view message) const {
        throw bad_program(
            joined({name_, ":", std::to_string(line), ":", std::to_string(column), ": ", message}));
    }
    [[noreturn]] void fail(std::string_view message) const {
        throw bad_program(joined({name_, ": ", message}));
    }

    /// Number without an exponent that begins at `at`, which then is behind it. Fails for none, and above 1e9.
    double fixed_number(std::size_t& at) const { return number(at, std::chars_format::fixed); }
    double any_number(std::size_t& at) const { return number(at, std::chars_format::general); }

private:
    int one() {
        try {
            return in_.rdbuf()->sbumpc();
        } catch (const std::ios_base::failure&) { // a directory
            fail("cannot be read");
        }
    }
    double number(std::size_t& at, std::chars_format form) const {
        const std::size_t from = at + (at < text_.size() && text_[at] == '+');
        const bool sign_only = from > at && from < text_.size() && text_[from] == '-';
        double value = 0;
        const auto [end, fault] =
            std::from_chars(text_.data() + from, text_.data() + text_.size(), value, form);
        if (fault == std::errc::invalid_argument || sign_only || !quadrant::detail::is_finite(value))
            fail(at, "a number is missing");
        if (fault != std::errc{} || std::abs(value) > 1e9) fail(at, "the number is out of range");
        at = static_cast<std::size_t>(end - text_.data());
        return value;
    }

    std::istream& in_;
    std::string name_, text_;
    std::size_t number_ = 0;
};

/// The moves that were read and not yet given away. The last one waits for what follows it: a dwell, a stop,
/// the end.
class waiting_moves {
public:
    void add(move next) {
        if (!any_) next.dwell_before = before_;
        any_ = true;
        moves_.push_back(next);
    }
    void stop() { end_with(path_ending::exact_stop, 0); }
    void end_with(path_ending ending, double tolerance) { ///< the last move
        if (!moves_.empty()) moves_.back().ending = ending, moves_.back().tolerance = tolerance;
    }
    void dwell(double seconds) {
        stop();
        (moves_.empty() ? before_ : moves_.back().dwell) += seconds;
    }
    bool any() const noexcept { return any_; }
    std::optional<move> take(bool at_end) {
        if (moves_.size() < (at_end ? 1u : 2u)) return {};
        const move first = moves_.front();
        moves_.pop_front();
        return first;
    }

private:
    std::deque<move> moves_;
    double before_ = 0;
    bool any_ = false;
};

} // namespace detail

/// Opens a program for a reader. Throws bad_program.
inline std::ifstream open_program(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw bad_program(detail::joined({detail::shown(path, 400), ": cannot be opened"}));
    return in;
}

} // namespace quadrant::inline v0::path
