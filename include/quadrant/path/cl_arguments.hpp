// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cl_statement.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::path::detail {

/// What stands behind the major word of a statement, from left to right.
class cl_arguments {
public:
    cl_arguments(const cl_statement& of, const program_lines& file) : of_(&of), file_(&file) {}

    bool more() const noexcept { return at_ < of_->rest.size(); }
    bool next_is(std::string_view text) const noexcept { return more() && of_->rest[at_].text == text; }
    bool next_is(cl_token::kind_of kind) const noexcept { return more() && of_->rest[at_].kind == kind; }
    void expect(std::string_view mark) {
        if (!next_is(mark)) fail(joined({"here must stand ", mark}));
        ++at_;
    }
    bool take(std::string_view text) {
        if (!next_is(text)) return false;
        ++at_;
        return true;
    }
    double number() {
        if (!next_is(cl_token::number)) fail("a number is missing");
        return of_->rest[at_++].value;
    }
    point place() {
        point out;
        out.x = number();
        expect(",");
        out.y = number();
        expect(",");
        out.z = number();
        return out;
    }
    /// A tool axis or a plane: only z, and its sense.
    double along_z() {
        const cl_arguments here = *this;
        const point axis = place();
        if (std::abs(axis.x) > 1e-6 || std::abs(axis.y) > 1e-6 || std::abs(std::abs(axis.z) - 1) > 1e-6)
            here.fail("only 0,0,1 and 0,0,-1 are supported here");
        return axis.z > 0 ? 1 : -1;
    }
    void end() const {
        if (more()) fail(joined({in_quotes(of_->rest[at_].text), " is not supported here"}));
    }
    [[noreturn]] void fail(std::string_view message) const {
        const bool here = more();
        file_->fail(here ? of_->rest[at_].line : of_->line, here ? of_->rest[at_].column : of_->column,
                    joined({of_->major, ": ", message}));
    }

private:
    const cl_statement* of_;
    const program_lines* file_;
    std::size_t at_ = 0;
};

} // namespace quadrant::inline v0::path::detail
