// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log.hpp"
#include "../read/decimal.hpp"
#include "../read/sample_clock.hpp"
#include "map.hpp"

namespace quadrant::diagnosis {

struct imported_log {
    machine_log log;                ///< in SI: metres or radians
    std::string text;               ///< as FORMAT.md writes a log
    std::vector<std::string> notes; ///< what was assumed, and what physics says of it
};

namespace detail {

/// One foreign log. Every row must be whole: nothing is resampled, nothing filled in.
class importer {
public:
    importer(const import_map& map, std::string_view text, std::string_view file)
        : map_(map), file_(file), rest_(without_byte_order_mark(text)) {}

    imported_log take() {
        if (map_.named()) find_header();
        if (map_.time) add(*map_.time, "t_s");
        for (const auto& a : map_.axes) {
            add(a.reference, a.name + "_ref_" + a.reference.si);
            add(a.position, a.name + "_pos_" + a.position.si);
            add(a.command, a.name + "_cmd_" + a.command.si);
        }
        read_rows();
        return assemble();
    }

private:
    struct column {
        std::string name;
        std::size_t index;
        double factor;
        std::vector<double> values{};
        written_step step{};
    };

    [[noreturn]] void refuse(std::size_t offset, std::string_view message) const {
        throw bad_input(file_, line_, characters(current_.substr(0, offset)) + 1, message);
    }
    bool next_line() {
        if (rest_.empty()) return false;
        const std::size_t end = rest_.find('\n');
        current_ = rest_.substr(0, end);
        rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
        if (current_.ends_with('\r')) current_.remove_suffix(1);
        ++line_;
        return true;
    }
    static bool blank(char c) { return c == ' ' || c == '\t'; }

    /// Cells of the current line with their offsets; quotes around a cell are taken off.
    void split() {
        cells_.clear();
        std::size_t at = 0;
        const std::string_view line = current_;
        const bool runs = map_.separator == ' ';
        while (at <= line.size()) {
            while (at < line.size() && line[at] != map_.separator && blank(line[at])) ++at;
            if (runs)
                while (at < line.size() && blank(line[at])) ++at;
            std::size_t end = at;
            if (at < line.size() && line[at] == '"') {
                end = line.find('"', at + 1);
                if (end == line.npos) refuse(at, "a quote is not closed before the end of the line");
                cells_.emplace_back(at, line.substr(at + 1, end - at - 1));
                while (end < line.size() && line[end] != map_.separator) ++end;
            } else {
                while (end < line.size() && (runs ? !blank(line[end]) : line[end] != map_.separator)) ++end;
                std::string_view cell = line.substr(at, end - at);
                cell = cell.substr(0, cell.find_last_not_of(" \t") + 1);
                if (!(runs && cell.empty())) cells_.emplace_back(at, cell);
            }
            at = end + 1;
        }
    }

    void find_header() {
        while (next_line()) {
            split();
            const bool here = map_.header_line > 0
                                  ? line_ == map_.header_line
                                  : !cells_.empty() && cells_[0].second == map_.header_begins_with;
            if (!here) continue;
            for (const auto& cell : cells_) names_.emplace_back(cell.second);
            return;
        }
        throw bad_input(file_,
                        map_.header_line > 0
                            ? fmt::format("ends before line {}, where the map has the names of the columns",
                                          map_.header_line)
                            : fmt::format("no line begins with {}, as the map says of the names of the columns",
                                          in_quotes(map_.header_begins_with)));
    }

    void add(const import_map::source& s, const std::string& name) {
        std::size_t index = s.number - 1;
        if (!s.column.empty()) {
            const auto found = std::find(names_.begin(), names_.end(), s.column);
            if (found == names_.end())
                throw bad_input(file_, line_, 1,
                                fmt::format("no column {}{} ({} of {})", in_quotes(s.column),
                                            suggestion(s.column, names_), s.place, map_.file));
            if (std::find(found + 1, names_.end(), s.column) != names_.end())
                throw bad_input(file_, line_, 1,
                                fmt::format("column {} is there twice: give its number in {} of {}",
                                            in_quotes(s.column), s.place, map_.file));
            index = static_cast<std::size_t>(found - names_.begin());
        }
        columns_.push_back({name, index, s.factor});
    }

    const char* parse(std::string_view cell, double& value) const {
        if (map_.decimal == '.') return parse_number(cell, value);
        if (cell.find('.') != cell.npos) return "has a decimal point where the map has a comma";
        std::string with_point(cell);
        std::replace(with_point.begin(), with_point.end(), ',', '.');
        return parse_number(with_point, value);
    }

    void read_rows() {
        std::size_t skipped = 0;
        bool blank_line = false;
        while (next_line()) {
            split();
            const bool empty = current_.find_first_not_of(" \t") == current_.npos;
            if (!map_.end.empty() && !cells_.empty() && cells_[0].second == map_.end) break;
            if (first_lines_.empty()) { // units, types and the like stand between the names and the rows
                double number = 0;
                const std::size_t look = columns_.front().index;
                if (empty || (map_.named() && (look >= cells_.size() || parse(cells_[look].second, number)))) {
                    ++skipped;
                    continue;
                }
            } else if (empty) {
                blank_line = true;
                continue;
            }
            if (blank_line) refuse(0, "the line before is blank, inside the log");
            first_lines_.push_back(line_);
            for (auto& c : columns_) {
                if (c.index >= cells_.size())
                    refuse(current_.size(), fmt::format("the row has {} cells; {} is number {}", cells_.size(),
                                                        c.name, c.index + 1));
                const auto [offset, cell] = cells_[c.index];
                double value = 0;
                if (const char* fault = parse(cell, value))
                    refuse(offset, fmt::format("{}: {} {}", c.name, in_quotes(cell), fault));
                c.values.push_back(value);
                std::string as_written(cell);
                std::replace(as_written.begin(), as_written.end(), ',', '.');
                c.step.add(as_written, value);
            }
        }
        if (first_lines_.size() < 2) throw bad_input(file_, "holds no rows of numbers that the map can read");
        if (skipped > 0)
            out_.notes.push_back(fmt::format(
                "{} lines between the names of the columns and the first row are skipped", skipped));
    }

    /// Digits behind the point that a column needs; no more than it had, where its factor is a power of ten, so that its
    /// rounding is still seen.
    static std::pair<int, bool> decimals(const column& c) {
        const double step = c.step.step() > 0 ? c.step.step() : 1,
                     power = -std::log10(step * std::abs(c.factor));
        const bool exact = std::abs(power - std::round(power)) < 1e-9;
        constexpr int guard = 3;
        return {std::clamp(static_cast<int>(exact ? std::round(power) : std::ceil(power) + guard), 0, 15),
                exact};
    }

    imported_log assemble() {
        const std::size_t rows = first_lines_.size();
        std::vector<double> t(rows);
        if (map_.time) {
            const auto& c = columns_.front();
            for (std::size_t k = 0; k < rows; ++k) t[k] = (c.values[k] - c.values[0]) * c.factor;
            const auto clock = read_clock(t, [&](std::size_t row, const std::string& message) {
                throw bad_input(file_, first_lines_[row], 1, message);
            });
            out_.log.sample_period_s = clock.period;
        } else {
            for (std::size_t k = 0; k < rows; ++k) t[k] = static_cast<double>(k) * map_.period_s;
            out_.log.sample_period_s = map_.period_s;
            out_.notes.push_back(fmt::format(
                "no time column: the rows are taken to be {:g} s apart, none missing", map_.period_s));
        }
        out_.log.file = one_line(file_);
        out_.log.samples = rows;
        const std::size_t first = map_.time ? 1 : 0;
        out_.text = "t_s";
        for (std::size_t i = first; i < columns_.size(); ++i) out_.text += ',' + columns_[i].name;
        out_.text += '\n';
        std::vector<int> digits;
        for (std::size_t i = first; i < columns_.size(); ++i) {
            const auto [d, exact] = decimals(columns_[i]);
            digits.push_back(d);
            if (!exact && columns_[i].step.step() > 0)
                out_.notes.push_back(fmt::format("{} is written with {} decimals; its own rounding is {:.3g}",
                                                 columns_[i].name, d,
                                                 columns_[i].step.step() * std::abs(columns_[i].factor)));
        }
        for (std::size_t k = 0; k < rows; ++k) {
            out_.text += fmt::format("{:.9f}", t[k]);
            for (std::size_t i = first; i < columns_.size(); ++i)
                out_.text +=
                    fmt::format(",{:.{}f}", columns_[i].values[k] * columns_[i].factor, digits[i - first]);
            out_.text += '\n';
        }
        for (std::size_t i = 0; i < map_.axes.size(); ++i) {
            const auto in_si = [&](std::size_t which) {
                auto& c = columns_[first + 3 * i + which];
                for (double& x : c.values) x *= c.factor;
                return std::move(c.values);
            };
            axis_log a;
            a.name = map_.axes[i].name;
            a.command_unit = map_.axes[i].command.si;
            a.reference = in_si(0);
            a.position = in_si(1);
            a.command = in_si(2);
            out_.log.axes.push_back(std::move(a));
        }
        return std::move(out_);
    }

    const import_map& map_;
    std::string_view file_, rest_, current_{};
    std::size_t line_ = 0;
    std::vector<std::pair<std::size_t, std::string_view>> cells_{};
    std::vector<std::string> names_{};
    std::vector<column> columns_{};
    std::vector<std::size_t> first_lines_{}; ///< line of each row
    imported_log out_{};
};

} // namespace detail

/// Reads another program's log through a map: columns renamed, numbers in SI, rows as they are. A missing row, a number
/// that is none, a column that is not there: bad_input with file, line and column.
inline imported_log import_log(const import_map& map, std::string_view text, std::string_view name) {
    return detail::importer(map, text, name).take();
}
inline imported_log import_log(const import_map& map, const std::filesystem::path& path) {
    return import_log(map, detail::read_whole(path), path.string());
}

} // namespace quadrant::diagnosis
