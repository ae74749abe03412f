// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "proposed_map.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// TwinCAT Scope's export to CSV: channels' properties line by line, then rows with one time column for all
/// channels or one before each. Members of the NC's axis structure are known by their names; the file's line
/// "Unit" says the units where somebody chose them.
class twincat_header {
public:
    static bool propose(proposed_map& out, std::string_view text, std::string_view file) {
        text = without_byte_order_mark(text);
        if (!text.starts_with("Name") || text.size() < 5 || is_letter(text[4])) return false;
        import_map::layout layout;
        layout.separator = text[4];
        return twincat_header(layout, text, file).read(out);
    }

private:
    twincat_header(const import_map::layout& layout, std::string_view text, std::string_view file)
        : separator_(layout.separator), lines_(layout, text, file) {}

    static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

    bool read(proposed_map& out) {
        std::vector<std::string> names, symbols, units, periods;
        std::size_t names_line = 0, symbols_line = 0;
        bool scope = false;
        for (std::size_t k = 0; k < most_header_lines && lines_.next(); ++k) {
            if (lines_.blank()) continue;
            const auto& cells = lines_.cells();
            scope = scope || cells[0].text == "Starttime of export" || cells[0].text == "StartRecord";
            if (cells[0].text == "Name") names = row(), names_line = lines_.number();
            if (cells[0].text == "SymbolName") symbols = row(), symbols_line = lines_.number();
            if (cells[0].text == "Unit") units = row();
            if (cells[0].text == "SampleTime[ms]") periods = row();
            if (!cells[0].text.empty() && is_digit(cells[0].text.front()) && !names.empty()) { // the first row
                comma_ = has_comma();
                stamps_ = cells[0].text.size() < filetime_digits ? "ms" : "100ns";
                break;
            }
        }
        if (!scope || names.empty()) return false;
        const bool by_symbol = symbols.size() == names.size();
        const auto& named = by_symbol ? symbols : names;
        const std::string label = named[0];
        for (std::size_t i = 0; i < named.size(); ++i) {
            proposed_map::column c{.name = named[i], .number = i + 1, .role = {}, .unit = {}};
            if (i < units.size()) c.unit = unit_in(units[i]);
            if (named[i] == label)
                c = {.name = "", .number = i + 1, .role = {}, .unit = stamps_, .time = i == 0};
            out.columns.push_back(c);
        }
        out.tool = "TwinCAT Scope";
        out.layout = {{"separator", separator_key(separator_)},
                      {"decimal", comma_ ? "," : "."},
                      {"header", by_symbol ? symbols_line : names_line},
                      {"end", "EOF"}};
        give_axes(out);
        same_period(out, periods);
        say_what_is_open(out);
        return true;
    }
    void give_axes(proposed_map& out) const {
        static constexpr known_signal known[] = {{"ActPos", "position", ""}, {"SetPos", "reference", ""}};
        std::vector<std::string> paths, axes;
        for (const auto& c : out.columns)
            if (leaf_of(c.name) == "ActPos" || leaf_of(c.name) == "SetPos")
                if (const std::string path = owner(c.name);
                    std::find(paths.begin(), paths.end(), path) == paths.end())
                    paths.push_back(path);
        for (std::size_t i = 0; i < paths.size(); ++i) {
            const std::string axis = paths.size() == 1 ? "x" : fmt::format("axis{}", i + 1);
            give_roles(out, axis, known, [&](const auto& c) { return owner(c.name) == paths[i]; });
            out.notes.push_back(
                fmt::format("axis {} is {}", axis, one_line(paths[i].empty() ? "that of the file" : paths[i])));
        }
    }
    /// Channels of other sample times have rows of their own.
    static void same_period(proposed_map& out, const std::vector<std::string>& periods) {
        const std::string* first = nullptr;
        for (const auto& c : out.columns)
            if (!c.role.empty() && c.number <= periods.size()) {
                if (first && *first != periods[c.number - 1])
                    out.open.push_back(
                        fmt::format("{} was sampled every {} ms, other columns every {} ms: export it "
                                    "in a file of its own and join the files",
                                    one_line(c.name), periods[c.number - 1], *first));
                if (!first) first = &periods[c.number - 1];
            }
    }
    /// What a signal belongs to: its path without the last part.
    static std::string owner(std::string_view path) {
        const std::size_t dot = path.rfind('.');
        return std::string(path.substr(0, dot == path.npos ? 0 : dot));
    }
    /// "mm (Length)": mm. "(None)": none.
    static std::string unit_in(std::string_view cell) {
        const std::string_view name = cell.substr(0, cell.find(' '));
        return find_unit(name) ? std::string(name) : "";
    }
    static bool is_digit(char c) { return c >= '0' && c <= '9'; }
    bool has_comma() const {
        return separator_ != ',' && std::any_of(lines_.cells().begin(), lines_.cells().end(),
                                                [](const auto& c) { return c.text.find(',') != c.text.npos; });
    }
    std::vector<std::string> row() const {
        std::vector<std::string> out;
        for (const auto& cell : lines_.cells()) out.emplace_back(cell.text);
        return out;
    }

    char separator_;
    static constexpr std::size_t filetime_digits =
        15; ///< "Full Timestamp"; else milliseconds from the first row
    bool comma_ = false;
    std::string stamps_ = "ms";
    foreign_lines lines_;
};

} // namespace quadrant::inline v0::diagnosis::detail
