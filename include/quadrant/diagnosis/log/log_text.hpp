// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/csv_cells.hpp"
#include "header_reader.hpp"
#include "log_header.hpp"
#include "log_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// The text of a log on its way to columns of numbers. It is walked once; a place is worked out only for a
/// message.
class log_text {
public:
    log_text(std::string_view text, std::string_view file, log_purpose purpose)
        : text_(without_byte_order_mark(text)), file_(file), purpose_(purpose) {
        text_ = text_.substr(0, text_.find_last_not_of(" \t\r\n") + 1);
        rest_ = text_;
    }

    /// Header and rows, or a refusal that names the place.
    void read() {
        if (text_.empty()) throw bad_input(file_, "is empty");
        const std::string_view first = next_line();
        header_ = read_header(
            first, [&](std::size_t offset, const std::string& message) { refuse(1, first, offset, message); },
            purpose_);
        reserve();
        while (!rest_.empty()) read_row(next_line());
        if (rows_ < 2)
            throw bad_input(file_, rows_ == 0 ? "holds no sample"
                                              : "holds one sample only: its period cannot be known");
    }
    log_header& header() { return header_; }

    /// The rows on the log's own even clock. Stamps that go back are refused, rows that stand twice dropped.
    log_rows on_the_clock() {
        const log_column& time = header_.columns[header_.time];
        const auto& t = time.values;
        for (std::size_t k = 1; k < rows_; ++k)
            if (t[k] < t[k - 1]) refuse_stamp(k, fmt::format("t_s: {} does not come after {}", t[k], t[k - 1]));
        std::vector<std::size_t> kept = rows_once(t, time.step.step());
        if (kept.size() < 2 || !(t[kept.back()] > t[kept.front()]))
            throw bad_input(file_, "all rows have one stamp: its period cannot be known");
        log_rows out(t, std::move(kept), time.step.step());
        const row_clock& clock = out.clock();
        if (!(clock.period > 0)) refuse_stamp(1, stamps_too_coarse);
        if (!clock.even && clock.spread > most_spread)
            refuse_stamp(
                out.row(clock.worst_step),
                fmt::format("t_s: the step to this stamp is {:.3g} s, and the period {:.3g} s; single steps "
                            "may be half a period off: resample the log with quadrant-gap import "
                            "--resample",
                            t[out.row(clock.worst_step)] - t[out.row(clock.worst_step - 1)], clock.period));
        return out;
    }

private:
    [[noreturn]] void refuse(std::size_t number, std::string_view line, std::size_t offset,
                             std::string_view message) const {
        throw bad_input(file_, number, characters(line.substr(0, offset)) + 1, message);
    }

    std::string_view next_line() {
        const std::size_t end = rest_.find('\n');
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
        ++line_;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    /// A cell in which a recorder had nothing to write.
    static bool no_reading(std::string_view cell) {
        double value = 0;
        return cell.empty() || (parse_number(cell, value) && std::isnan(value));
    }

    void reserve() {
        const auto lines = static_cast<std::size_t>(std::count(rest_.begin(), rest_.end(), '\n')) + 1;
        const std::size_t most =
            rest_.size() / (2 * header_.columns.size()) + 1; // a cell has a digit and a comma
        for (auto& column : header_.columns)
            if (column.used) column.values.reserve(std::min(lines, most));
    }

    void read_row(std::string_view line) {
        auto& columns = header_.columns;
        if (line.find_first_not_of(" \t") == line.npos) refuse(line_, line, 0, "a blank line inside the log");
        csv_cells cells(line);
        std::size_t index = 0;
        for (; cells.next(); ++index) {
            if (cells.broken())
                refuse(line_, line, cells.offset(),
                       "a quote is not closed before the comma or the end of the line");
            if (index == columns.size())
                refuse(line_, line, cells.offset(),
                       fmt::format("more cells than the {} of the header", columns.size()));
            auto& column = columns[index];
            if (!column.used) continue;
            double value = 0;
            if (const char* fault = parse_number(cells.text(), value))
                refuse(line_, line, cells.offset(),
                       fmt::format("{}: {} {}{}", column.name, in_quotes(cells.text()), fault,
                                   no_reading(cells.text()) ? ": leave the row out, and it will be filled in"
                                                            : ""));
            column.values.push_back(value);
            column.step.add(cells.text(), value);
        }
        if (index < columns.size())
            refuse(line_, line, line.size(),
                   fmt::format("the row has {} cells, the header {}", index, columns.size()));
        ++rows_;
    }

    /// Of a row that was read without fault: its stamp.
    [[noreturn]] void refuse_stamp(std::size_t row, std::string_view message) {
        rest_ = text_;
        line_ = 0;
        std::string_view line = next_line();
        for (std::size_t k = 0; k <= row; ++k) line = next_line();
        csv_cells cells(line);
        for (std::size_t k = 0; k <= header_.time; ++k) cells.next();
        refuse(line_, line, cells.offset(), message);
    }

    std::string_view text_, rest_, file_;
    log_purpose purpose_;
    std::size_t line_ = 0, rows_ = 0;
    log_header header_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
