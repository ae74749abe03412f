// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "program_text.hpp"

#include <algorithm>
#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrant::inline v0::path::detail {

/// A word, a number or one of / , ( ) of a CL file, and where it stands.
struct cl_token {
    enum kind_of { word, number, mark } kind;
    std::string text; ///< in capitals
    double value;
    std::size_t line, column;
};

/// One statement: MAJOR/MINOR,... over as many lines as a $ at their ends asks for.
struct cl_statement {
    std::string major; ///< empty: a line without a statement
    std::vector<cl_token> rest;
    std::size_t line = 0, column = 0; ///< of the major word
};

/// Statements of a CL file, one at a time. $$ begins a comment, what follows a $ is not read; neither are
/// columns 73 and after when column 73 begins a word after a blank (the sequence field that CATIA writes).
class cl_statements {
public:
    static constexpr std::size_t most = 1000; ///< tokens of a statement

    cl_statements(std::istream& in, std::string_view name) : lines_(in, name) {}

    /// False at the end of the file. Of a major word for which `is_text` holds only that word is read.
    template <class IsText> bool next(cl_statement& out, IsText is_text) {
        out = {};
        if (!lines_.next()) return false;
        std::size_t at = skip_blanks(0);
        if (at >= used().size()) return true;
        const std::size_t from = at;
        while (at < used().size() && in_word(used()[at])) out.major += upper(used()[at++]);
        out.line = lines_.number(), out.column = lines_.column(from);
        if (out.major.empty())
            lines_.fail(from, joined({in_quotes(used().substr(from, 1)), " does not begin a statement"}));
        if (is_text(out.major)) {
            while (continues()) need_next();
            return true;
        }
        tokens(out, at);
        while (continues()) {
            need_next();
            tokens(out, 0);
        }
        return true;
    }
    std::size_t number() const noexcept { return lines_.number(); }
    const program_lines& lines() const noexcept { return lines_; }

private:
    static constexpr bool in_word(char c) noexcept {
        return is_letter(c) || is_digit(c) || c == '-' || c == '_';
    }

    /// The line without comment, continuation and sequence field.
    std::string_view used() const {
        std::string_view text = lines_.text();
        if (text.size() > 72 && is_blank(text[71]) && is_letter(text[72])) text = text.substr(0, 72);
        return text.substr(0, std::min(text.size(), text.find('$')));
    }
    bool continues() const {
        const std::string_view text = lines_.text();
        const std::size_t at = text.find('$');
        return at != std::string_view::npos && (at + 1 == text.size() || text[at + 1] != '$');
    }
    void need_next() {
        if (!lines_.next()) lines_.fail("ends inside a statement");
    }
    std::size_t skip_blanks(std::size_t at) const {
        while (at < used().size() && is_blank(used()[at])) ++at;
        return at;
    }
    void tokens(cl_statement& out, std::size_t at) const {
        while ((at = skip_blanks(at)) < used().size()) {
            const char c = used()[at];
            cl_token next{cl_token::mark, {}, 0, lines_.number(), lines_.column(at)};
            if (is_letter(c)) {
                next.kind = cl_token::word;
                while (at < used().size() && in_word(used()[at])) next.text += upper(used()[at++]);
            } else if (std::string_view("/,()").find(c) != std::string_view::npos) {
                next.text = c;
                ++at;
            } else {
                const std::size_t from = at;
                next.kind = cl_token::number;
                if (!is_digit(c) && std::string_view("+-.").find(c) == std::string_view::npos)
                    lines_.fail(at, joined({in_quotes(used().substr(at, 1)), " is not supported"}));
                next.value = lines_.any_number(at);
                next.text = used().substr(from, at - from);
            }
            if (out.rest.size() == most) lines_.fail(at, "the statement is too long");
            out.rest.push_back(std::move(next));
        }
    }

    program_lines lines_;
};

} // namespace quadrant::inline v0::path::detail
