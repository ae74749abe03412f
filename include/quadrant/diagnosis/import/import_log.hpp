// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log.hpp"
#include "../read/sample_clock.hpp"
#include "foreign_lines.hpp"

namespace quadrant::diagnosis {

/// Another program's log in the words of ours.
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
        : map_(map), file_(file), lines_(map, text, file) {}

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

    void find_header() {
        while (lines_.next()) {
            const bool here = map_.header_line > 0 ? lines_.number() == map_.header_line
                                                   : lines_.begins_with(map_.header_begins_with);
            if (!here) continue;
            for (const auto& cell : lines_.cells()) names_.emplace_back(cell.text);
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
                lines_.refuse(0, fmt::format("no column {}{} ({} of {})", in_quotes(s.column),
                                             suggestion(s.column, names_), s.place, map_.file));
            if (std::find(found + 1, names_.end(), s.column) != names_.end())
                lines_.refuse(0, fmt::format("column {} is there twice: give its number in {} of {}",
                                             in_quotes(s.column), s.place, map_.file));
            index = static_cast<std::size_t>(found - names_.begin());
        }
        columns_.push_back({name, index, s.factor});
    }

    void read_rows() {
        std::size_t skipped = 0;
        bool blank_line = false;
        while (lines_.next()) {
            const auto& cells = lines_.cells();
            if (!map_.end.empty() && lines_.begins_with(map_.end)) break;
            if (first_lines_.empty()) { // units, types and the like stand between the names and the rows
                double number = 0;
                const std::size_t look = columns_.front().index;
                if (lines_.blank() ||
                    (map_.named() && (look >= cells.size() || lines_.parse(cells[look].text, number)))) {
                    ++skipped;
                    continue;
                }
            } else if (lines_.blank()) {
                blank_line = true;
                continue;
            }
            if (blank_line) lines_.refuse(0, "the line before is blank, inside the log");
            first_lines_.push_back(lines_.number());
            for (auto& c : columns_) read_cell(c, cells);
        }
        if (first_lines_.size() < 2) throw bad_input(file_, "holds no rows of numbers that the map can read");
        if (skipped > 0)
            out_.notes.push_back(fmt::format(
                "{} lines between the names of the columns and the first row are skipped", skipped));
    }

    void read_cell(column& c, const std::vector<foreign_lines::cell>& cells) const {
        if (c.index >= cells.size())
            lines_.refuse(lines_.length(), fmt::format("the row has {} cells; {} is number {}", cells.size(),
                                                       c.name, c.index + 1));
        const auto [offset, text] = cells[c.index];
        double value = 0;
        if (const char* fault = lines_.parse(text, value))
            lines_.refuse(offset, fmt::format("{}: {} {}", c.name, in_quotes(text), fault));
        c.values.push_back(value);
        std::string as_written(text);
        std::replace(as_written.begin(), as_written.end(), ',', '.');
        c.step.add(as_written, value);
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
        out_.log.file = one_line(file_);
        out_.log.samples = first_lines_.size();
        write(stamps());
        std::size_t next = first_signal();
        const auto in_si = [&] {
            column& c = columns_[next++];
            for (double& x : c.values) x *= c.factor;
            return std::move(c.values);
        };
        for (const auto& axis : map_.axes) {
            axis_log a;
            a.name = axis.name;
            a.command_unit = axis.command.si;
            a.kind = axis.position.si == "rad" ? axis_kind::rotary : axis_kind::linear;
            a.reference = in_si();
            a.position = in_si();
            a.command = in_si();
            out_.log.axes.push_back(std::move(a));
        }
        return std::move(out_);
    }

    std::size_t first_signal() const { return map_.time ? 1 : 0; }

    /// Time of each row from the first; sets the sample period.
    std::vector<double> stamps() {
        std::vector<double> t(first_lines_.size());
        if (map_.time) {
            const auto& c = columns_.front();
            for (std::size_t k = 0; k < t.size(); ++k) t[k] = (c.values[k] - c.values[0]) * c.factor;
            const auto clock = read_clock(t, [&](std::size_t row, const std::string& message) {
                throw bad_input(file_, first_lines_[row], 1, message);
            });
            out_.log.sample_period_s = clock.period;
        } else {
            for (std::size_t k = 0; k < t.size(); ++k) t[k] = static_cast<double>(k) * map_.period_s;
            out_.log.sample_period_s = map_.period_s;
            out_.notes.push_back(fmt::format(
                "no time column: the rows are taken to be {:g} s apart, none missing", map_.period_s));
        }
        return t;
    }

    void write(const std::vector<double>& t) {
        const std::span signals = std::span(columns_).subspan(first_signal());
        std::vector<int> digits;
        out_.text = "t_s";
        for (const column& c : signals) {
            out_.text += ',' + c.name;
            const auto [d, exact] = decimals(c);
            digits.push_back(d);
            if (!exact && c.step.step() > 0)
                out_.notes.push_back(fmt::format("{} is written with {} decimals; its own rounding is {:.3g}",
                                                 c.name, d, c.step.step() * std::abs(c.factor)));
        }
        out_.text += '\n';
        for (std::size_t k = 0; k < t.size(); ++k) {
            out_.text += fmt::format("{:.9f}", t[k]);
            for (std::size_t i = 0; i < signals.size(); ++i)
                out_.text += fmt::format(",{:.{}f}", signals[i].values[k] * signals[i].factor, digits[i]);
            out_.text += '\n';
        }
    }

    const import_map& map_;
    std::string_view file_;
    foreign_lines lines_;
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
