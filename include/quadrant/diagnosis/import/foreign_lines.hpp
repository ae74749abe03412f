// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/decimal.hpp"
#include "../text/text.hpp"
#include "map.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// The lines of another program's log, one after the other, cut into cells as a map says.
class foreign_lines {
public:
    struct cell {
        std::size_t offset;
        std::string_view text; ///< without quotes and blanks around it
    };

    foreign_lines(import_map::layout layout, std::string_view text, std::string_view file)
        : layout_(std::move(layout)), file_(file), rest_(without_byte_order_mark(text)) {}

    bool next() {
        if (rest_.empty()) return false;
        const std::size_t end = rest_.find('\n');
        current_ = rest_.substr(0, end);
        rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
        if (current_.ends_with('\r')) current_.remove_suffix(1);
        ++number_;
        split();
        return true;
    }
    std::size_t number() const { return number_; } ///< from 1
    std::string_view current() const { return current_; }
    std::size_t length() const { return current_.size(); }
    bool blank() const { return current_.find_first_not_of(" \t") == current_.npos; }
    const std::vector<cell>& cells() const { return cells_; }
    bool begins_with(std::string_view text) const { return !cells_.empty() && cells_[0].text == text; }

    [[noreturn]] void refuse(std::size_t offset, std::string_view message) const {
        throw bad_input(file_, number_, characters(current_.substr(0, offset)) + 1, message);
    }
    /// Whether a cell is there and holds nothing, as where a drive had not answered yet.
    bool lacks(std::size_t index) const {
        if (index >= cells_.size()) return false;
        const std::string_view text = cells_[index].text;
        return text.empty() || text == "nan" || text == "NaN" || text == "NA";
    }
    /// One entry, from 1, of a cell that holds a list: "[1.5, 2.5]", "(1.5 2.5)", "1.5;2.5".
    std::string_view entry(std::string_view list, std::size_t offset, std::size_t wanted,
                           std::string_view column) const {
        constexpr std::string_view between = " \t,;[]()";
        std::size_t at = 0;
        for (std::size_t k = 1;; ++k) {
            at = list.find_first_not_of(between, at);
            if (at == list.npos)
                refuse(offset, fmt::format("{}: the list has {} entries; {} is number {}", in_quotes(list),
                                           k - 1, column, wanted));
            const std::size_t end = std::min(list.find_first_of(between, at), list.size());
            if (k == wanted) return list.substr(at, end - at);
            at = end;
        }
    }
    /// The number in a cell; null, or what is wrong with it.
    const char* parse(std::string_view text, double& value) const {
        if (layout_.decimal == '.') return parse_number(text, value);
        if (text.find('.') != text.npos) return "has a decimal point where the map has a comma";
        std::string with_point(text);
        std::replace(with_point.begin(), with_point.end(), ',', '.');
        return parse_number(with_point, value);
    }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t'; }

    void split() {
        cells_.clear();
        std::size_t at = 0;
        const std::string_view line = current_;
        const bool runs = layout_.separator == ' ';
        while (at <= line.size()) {
            while (at < line.size() && line[at] != layout_.separator && is_blank(line[at])) ++at;
            if (runs)
                while (at < line.size() && is_blank(line[at])) ++at;
            std::size_t end = at;
            if (at < line.size() && line[at] == '"') {
                end = line.find('"', at + 1);
                if (end == line.npos) refuse(at, "a quote is not closed before the end of the line");
                cells_.push_back({at, line.substr(at + 1, end - at - 1)});
                while (end < line.size() && line[end] != layout_.separator) ++end;
            } else {
                while (end < line.size() && (runs ? !is_blank(line[end]) : line[end] != layout_.separator))
                    ++end;
                std::string_view text = line.substr(at, end - at);
                text = text.substr(0, text.find_last_not_of(" \t") + 1);
                if (!(runs && text.empty())) cells_.push_back({at, text});
            }
            at = end + 1;
        }
    }

    import_map::layout layout_;
    std::string_view file_, rest_, current_{};
    std::size_t number_ = 0;
    std::vector<cell> cells_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
