// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/row_clock.hpp"
#include "../text/json_node.hpp"
#include "clock_time.hpp"
#include "foreign_lines.hpp"
#include "foreign_table.hpp"
#include "halscope_file.hpp"
#include "missing_column.hpp"
#include "number_table.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Reads one file by its layout.
class foreign_table_reader {
public:
    /// `first_day`: from which clock times count, the same for all files of a log.
    foreign_table_reader(const import_map& map, std::size_t file, std::string_view text, std::string_view name,
                         std::optional<long>& first_day)
        : map_(map), layout_(layout_of(map.files[file], text)), file_(file), name_(name),
          lines_(layout_, text, name), first_day_(first_day) {}

    foreign_table take() {
        if (layout_.halscope)
            begin_halscope();
        else if (layout_.named())
            find_header();
        if (layout_.time) add(*layout_.time, "t_s");
        for (const auto& a : map_.axes)
            for (const auto& s : a.signals)
                if (s.from.file == file_) add(s.from, a.name + column_of(a, s));
        read_rows();
        keep_stamps();
        return std::move(out_);
    }

    /// The rest of a column's name behind that of its axis. A measured current or torque says so by its name.
    static std::string column_of(const import_map::axis& a, const import_map::signal& s) {
        const bool measured = s.role == signal_role::command && a.command_is == command_origin::measured;
        if (measured && s.from.si == "A") return "_current_A";
        if (measured && s.from.si == "Nm") return "_torque_Nm";
        return std::string(kind_of(s.role).infix) + (s.from.si == "1" ? "" : s.from.si);
    }

private:
    void find_header() {
        while (lines_.next()) {
            const bool here = layout_.header_line > 0 ? lines_.number() == layout_.header_line
                                                      : lines_.begins_with(layout_.header_begins_with);
            if (!here) continue;
            for (const auto& cell : lines_.cells()) names_.emplace_back(cell.text);
            return;
        }
        throw bad_input(
            name_, layout_.header_line > 0
                       ? fmt::format("ends before line {}, where the map expects the names of the columns",
                                     layout_.header_line)
                       : fmt::format("no line begins with {}, where the map expects the names of the columns",
                                     in_quotes(layout_.header_begins_with)));
    }

    static import_map::layout layout_of(const import_map::layout& given, std::string_view text) {
        return given.halscope ? halscope_file::layout_of(given, text) : given;
    }
    void begin_halscope() {
        scope_ = halscope_file::read(lines_, layout_);
        if (!scope_ && lines_.number() == 0) throw bad_input(name_, "is empty");
        if (!scope_)
            lines_.refuse(0, "is not what halscope saves: the first line must be \"Sampling period is N ns\", "
                             "\"nSec\" in place of \"ns\", or either behind a \"#\"");
        names_ = scope_->names;
        again_ = scope_->in_turns;
    }

    void add(const import_map::source& s, const std::string& name) {
        std::size_t index = s.number - 1;
        if (!s.column.empty()) {
            const auto found = std::find(names_.begin(), names_.end(), s.column);
            if (found == names_.end())
                lines_.refuse(0, fmt::format("no column {}{} ({} of {})", in_quotes(s.column),
                                             instead_of(s.column, names_), s.place, map_.file));
            if (std::find(found + 1, names_.end(), s.column) != names_.end())
                lines_.refuse(0, fmt::format("column {} is there twice: give its number in {} of {}",
                                             in_quotes(s.column), s.place, map_.file));
            index = static_cast<std::size_t>(found - names_.begin());
        }
        if (scope_) index = scope_->cell_of(index);
        out_.columns.push_back({name, index, s.factor, s.element});
    }

    bool next() { return std::exchange(again_, false) || lines_.next(); }

    void read_rows() {
        std::size_t skipped = 0, lacking = 0;
        bool blank_line = false;
        while (next()) {
            const auto& cells = lines_.cells();
            if (!layout_.end.empty() && lines_.begins_with(layout_.end)) break;
            if (scope_ && out_.line.empty() && lines_.current().starts_with('#')) continue;
            if (out_.line.empty()) { // units, types and the like stand between the names and the rows
                double number = 0;
                const std::size_t look = out_.columns.empty() ? 0 : out_.columns.front().index;
                if (lines_.blank() ||
                    (layout_.named() &&
                     (look >= cells.size() || lines_.parse(as_number(look, cells[look]), number)))) {
                    ++skipped;
                    continue;
                }
            } else if (lines_.blank()) {
                blank_line = true;
                continue;
            }
            if (blank_line) lines_.refuse(0, "the line before is blank, inside the log");
            if (ended(cells)) break;
            const auto lacks = [&](const foreign_column& c) { return lines_.lacks(c.index); };
            if (layout_.time && std::any_of(out_.columns.begin() + 1, out_.columns.end(), lacks)) {
                ++lacking; // its stamp tells that it is missing
                continue;
            }
            out_.line.push_back(lines_.number());
            for (auto& c : out_.columns) read_cell(c, cells);
        }
        if (scope_ && scope_->in_turns && out_.line.size() > 1) drop_last();
        if (out_.line.size() < 2)
            throw bad_input(name_, lacking > 0
                                       ? "holds no rows of numbers that the map can read: every row has an "
                                         "empty cell or nan in a column that it asks for"
                                       : "holds no rows of numbers that the map can read");
        if (lacking > 0)
            out_.notes.push_back(fmt::format("{} rows lack a value that the map asks for: left out", lacking));
        if (skipped > 0)
            out_.notes.push_back(fmt::format(
                "{} lines between the names of the columns and the first row are skipped", skipped));
    }
    /// Whether the columns of the log are over; a file of numbers may hold longer ones.
    bool ended(const std::vector<foreign_lines::cell>& cells) const {
        const auto over = [&](const foreign_column& c) {
            return c.index < cells.size() && cells[c.index].text == past_the_end;
        };
        const auto first = std::find_if(out_.columns.begin(), out_.columns.end(), over);
        if (first == out_.columns.end()) return false;
        const auto longer = std::find_if_not(out_.columns.begin(), out_.columns.end(), over);
        if (longer != out_.columns.end())
            lines_.refuse(cells[first->index].offset,
                          fmt::format("{} has no more rows, {} goes on: the columns of one log have one length",
                                      first->name, longer->name));
        return true;
    }
    /// halscope writes one row more than it sampled.
    void drop_last() {
        out_.line.pop_back();
        for (auto& c : out_.columns) c.values.pop_back();
        out_.notes.push_back("the last row is dropped: halscope saves one more than it sampled");
    }

    /// The text of a cell; a clock time among the stamps as seconds since the day of the first one.
    std::string as_number(std::size_t column, const foreign_lines::cell& cell) {
        std::string out(cell.text);
        if (!layout_.time || column != out_.columns.front().index) return out;
        const auto stamp = clock_reader::read(cell.text);
        if (!stamp) return out;
        if (out_.columns.front().factor != 1)
            lines_.refuse(cell.offset, fmt::format("{} is a clock time: its unit is s", in_quotes(cell.text)));
        if (!first_day_) first_day_ = stamp->day;
        const double seconds = 86400.0 * static_cast<double>(stamp->day - *first_day_) + stamp->second;
        out = fmt::format("{:.{}f}", seconds, stamp->digits);
        if (stamp->digits == 0) out += '.'; // whole seconds, and no trailing zeros
        std::replace(out.begin(), out.end(), '.', layout_.decimal);
        return out;
    }

    void read_cell(foreign_column& c, const std::vector<foreign_lines::cell>& cells) {
        if (c.index >= cells.size())
            lines_.refuse(lines_.length(), fmt::format("the row has {} cells; {} is number {}", cells.size(),
                                                       c.name, c.index + 1));
        const auto [offset, cell] = cells[c.index];
        const std::string_view text = c.element == 0 ? cell : lines_.entry(cell, offset, c.element, c.name);
        double value = 0;
        std::string as_written = as_number(c.index, {offset, text});
        if (const char* fault = lines_.parse(as_written, value))
            lines_.refuse(offset, fmt::format("{}: {} {}", c.name, in_quotes(text), fault));
        c.values.push_back(value);
        std::replace(as_written.begin(), as_written.end(), ',', '.');
        c.written.add(as_written, value);
    }

    /// Stamps in seconds; rows whose stamp is that of the row before are dropped.
    void keep_stamps() {
        const std::size_t n = out_.line.size();
        const double period = scope_ ? scope_->period_s : layout_.period_s;
        if (!layout_.time) {
            for (std::size_t k = 0; k < n; ++k) out_.t.push_back(static_cast<double>(k) * period);
            out_.notes.push_back(
                fmt::format("no time column: the rows are taken to be {:g} s apart, none missing", period));
        } else {
            const foreign_column time = std::move(out_.columns.front());
            out_.columns.erase(out_.columns.begin());
            out_.written = time.step();
            take_stamps(time);
        }
        for (auto& c : out_.columns)
            for (double& x : c.values) x *= c.factor;
    }
    void take_stamps(const foreign_column& time) {
        const auto& stamp = time.values;
        const std::size_t n = stamp.size();
        for (std::size_t k = 1; k < n; ++k)
            if (stamp[k] < stamp[k - 1])
                throw bad_input(
                    name_, out_.line[k], 1,
                    fmt::format("t_s: {} does not come after {}: cut the file here, or sort its rows",
                                stamp[k] * time.factor, stamp[k - 1] * time.factor));
        const std::vector<std::size_t> kept = rows_once(stamp, time.written.step());
        const std::size_t doubled = n - kept.size();
        if (doubled > 0) {
            out_.notes.push_back(
                fmt::format("{} rows have the stamp of the row before and are dropped", doubled));
            for (auto& c : out_.columns) c.values = taken(c.values, kept);
            out_.line = taken(out_.line, kept);
        }
        if (kept.size() < 2 || !(stamp[kept.back()] > stamp[kept.front()]))
            throw bad_input(name_, "all rows have one stamp");
        for (const std::size_t k : kept) out_.t.push_back(stamp[k] * time.factor);
        if (!(clock_of_rows(out_.t, time.step()).period > 0)) throw bad_input(name_, stamps_too_coarse);
    }
    template <class T>
    static std::vector<T> taken(const std::vector<T>& x, const std::vector<std::size_t>& rows) {
        std::vector<T> out;
        out.reserve(rows.size());
        for (const std::size_t k : rows) out.push_back(x[k]);
        return out;
    }

    const import_map& map_;
    import_map::layout layout_;
    std::size_t file_;
    std::string_view name_;
    foreign_lines lines_;
    std::optional<halscope_file> scope_{}; ///< where halscope saved the file
    bool again_ = false;                   ///< the current line is a row that is not yet read
    std::vector<std::string> names_{};
    std::optional<long>& first_day_;
    foreign_table out_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
