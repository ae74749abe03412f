// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "column_words.hpp"
#include "proposed_map.hpp"

#include <utility>

namespace quadrant::inline v0::diagnosis::detail {

/// A table of which nobody knows who wrote it: columns by their names, where a line has some, and what the
/// words and units of a name say. What two columns say alike stays open.
class any_table {
public:
    static bool propose(proposed_map& out, std::string_view text, std::string_view file) {
        for (const char separator : {';', '\t', ',', ' '}) {
            any_table table(separator);
            if (table.find_rows(text, file)) return table.read(out);
        }
        return false;
    }

private:
    using row = std::vector<std::string>;

    explicit any_table(char separator) { layout_.separator = separator; }

    /// Goes to the first row of numbers; true where there is one of at least two cells. A stamp may be a time
    /// of day, and cells may be empty, as behind the last comma of a spreadsheet.
    bool find_rows(std::string_view text, std::string_view file) {
        foreign_lines lines(layout_, text, file);
        for (std::size_t k = 0; k < most_header_lines && lines.next(); ++k) {
            row cells;
            std::size_t numbers = 0, lacking = 0, nans = 0;
            for (std::size_t i = 0; const auto& cell : lines.cells()) {
                cells.emplace_back(cell.text);
                lacking += lines.lacks(i++);
                nans += cell.text.starts_with("nan") || cell.text.starts_with("NaN");
                double value = 0;
                const bool comma = layout_.separator != ',' && cell.text.find(',') != cell.text.npos;
                std::string number = cells.back();
                if (comma) std::replace(number.begin(), number.end(), ',', '.');
                if (parse_number(number, value)) continue;
                ++numbers;
                if (comma) layout_.decimal = ',';
            }
            if (numbers >= 2 && numbers + lacking + 1 >= cells.size()) {
                columns_ = cells.size();
                return true;
            }
            const bool before_the_first_value = nans >= 2; // a row whose drive had not answered yet
            if (cells.size() > 1 && !before_the_first_value)
                before_.emplace_back(lines.number(), std::move(cells));
        }
        return false;
    }

    bool read(proposed_map& out) {
        row names(columns_), units(columns_);
        std::size_t header = 0; // 0: no line has names
        for (const auto& [number, cells] : before_) {
            if (cells.size() != columns_) continue;
            const bool are_units = header > 0 && std::all_of(cells.begin(), cells.end(), [](const auto& c) {
                                       return c.empty() || bare(c) != c || find_unit(c);
                                   });
            if (!are_units) header = number;
            (are_units ? units : names) = cells;
        }
        out.layout = {{"separator", separator_key(layout_.separator)},
                      {"decimal", std::string(1, layout_.decimal)}};
        if (header > 0) out.layout["header"] = header;
        for (std::size_t i = 0; i < columns_; ++i) add(out, names[i], bare(units[i]));
        part_by_axis(out);
        open_what_is_twofold(out);
        say_what_names_lack(out);
        if (header == 0)
            out.open.emplace_back("which column is what: no line has their names, they go by number");
        say_what_is_open(out);
        return true;
    }

    /// "[mm]", behind the sign of a comment, too: mm.
    static std::string_view bare(std::string_view unit) {
        while (unit.size() > 1 && (unit.front() == '%' || unit.front() == '#')) unit.remove_prefix(1);
        if (unit.size() > 2 && (unit.front() == '[' || unit.front() == '('))
            unit = unit.substr(1, unit.size() - 2);
        return unit;
    }

    static void add(proposed_map& out, const std::string& name, std::string_view unit) {
        const column_words words(unit.empty() ? name : name + " [" + std::string(unit) + ']');
        proposed_map::column c{.name = name, .number = out.columns.size() + 1, .role = {}, .unit = {}};
        if (words.unit()) c.unit = words.unit()->name;
        const bool timed =
            std::any_of(out.columns.begin(), out.columns.end(), [](const auto& x) { return x.time; });
        c.time = !timed && words.is_time();
        if (!c.time) c.role = words.role();
        c.axis = words.axis();
        c.is_measured = c.role == "command" && words.is_measured();
        out.columns.push_back(std::move(c));
    }

    /// One position is one axis, whose all other signals are; several go by their names.
    static void part_by_axis(proposed_map& out) {
        std::vector<std::string> axes;
        for (const auto& c : out.columns)
            if (c.role == "position") axes.push_back(c.axis);
        for (auto& c : out.columns) {
            const bool is_one = std::find(axes.begin(), axes.end(), c.axis) != axes.end();
            if (axes.size() > 1 && !is_one) c.role.clear();
            if (axes.size() == 1) c.axis = axes.front();
            if (c.axis.empty()) c.axis = "x";
        }
    }

    static void open_what_is_twofold(proposed_map& out) {
        const auto is_like = [](const proposed_map::column& a, const proposed_map::column& b) {
            return &a != &b && !a.role.empty() && a.role == b.role && a.axis == b.axis;
        };
        std::vector<bool> twofold(out.columns.size());
        for (std::size_t i = 0; i < out.columns.size(); ++i)
            for (std::size_t j = 0; j < out.columns.size(); ++j) {
                const auto &a = out.columns[i], &b = out.columns[j];
                if (!is_like(a, b)) continue;
                if (i < j && !twofold[j])
                    out.open.push_back(fmt::format("{} and {} may both be the {} of {}", one_line(a.name),
                                                   one_line(b.name), a.role, a.axis));
                twofold[i] = twofold[j] = true;
            }
        for (std::size_t i = 0; i < out.columns.size(); ++i)
            if (twofold[i]) out.columns[i].role.clear();
    }

    /// Of stamps, and of a current or torque, what a name rarely says.
    static void say_what_names_lack(proposed_map& out) {
        if (std::none_of(out.columns.begin(), out.columns.end(), [](const auto& c) { return c.time; })) {
            out.layout["time"] = {{"period_s", "?"}};
            out.open.emplace_back(
                "the column of the time, or how far the rows are apart (\"time\": {\"period_s\": 0.001})");
        }
        for (const auto& c : out.columns)
            if (c.role == "command" && c.unit != "V" && !c.is_measured)
                out.open.push_back(fmt::format("whether {} is asked by the controller, or was measured behind "
                                               "the amplifier (\"is\": \"measured\")",
                                               one_line(c.name)));
    }

    import_map::layout layout_{};
    std::vector<std::pair<std::size_t, row>> before_{}; ///< lines in front of the rows, with their numbers
    std::size_t columns_ = 0;
};

} // namespace quadrant::inline v0::diagnosis::detail
