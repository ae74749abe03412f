// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "foreign_lines.hpp"
#include "map.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// The head of a file that halscope of LinuxCNC saved: the period, then the names of the channels. Up to
/// LinuxCNC 2.8 each row has name and value of every channel in turns, with the decimal sign of the user's
/// language, and one row more than was sampled; from 2.9 on the names stand once, above columns with ';'
/// between them, and newer ones write how the channels were drawn below the names, behind a '#'.
struct halscope_file {
    double period_s = 0;
    bool in_turns = true;
    std::vector<std::string> names{};

    static import_map::layout layout_of(import_map::layout out, std::string_view text) {
        const std::string_view rows = text.substr(std::min(text.find('\n'), text.size()));
        out.separator = text.starts_with('#') ? ';' : ' ';
        out.decimal = out.separator == ' ' && rows.find(',') != rows.npos ? ',' : '.';
        return out;
    }
    /// Reads the head; the current line is then the first row (`in_turns`), or the names above it. None:
    /// another program wrote the file.
    static std::optional<halscope_file> read(foreign_lines& lines, const import_map::layout& layout) {
        if (!lines.next()) return std::nullopt;
        std::string words(lines.current());
        if (words.starts_with('#')) words[0] = ' ';
        import_map::layout blanks;
        blanks.separator = ' ';
        foreign_lines first(blanks, words, "");
        first.next();
        const auto& cells = first.cells();
        halscope_file out;
        if (cells.size() < 5 || cells[0].text != "Sampling" ||
            (cells[4].text != "ns" && cells[4].text != "nSec") || first.parse(cells[3].text, out.period_s) ||
            !(out.period_s > 0))
            return std::nullopt;
        out.period_s *= 1e-9;
        out.in_turns = layout.separator == ' ';
        while (lines.next()) {
            if (lines.blank()) continue;
            for (std::size_t i = 0; i < lines.cells().size(); i += out.in_turns ? 2 : 1)
                out.names.emplace_back(lines.cells()[i].text);
            break;
        }
        return out;
    }
    /// Place of a channel's value in a row.
    std::size_t cell_of(std::size_t channel) const { return in_turns ? 2 * channel + 1 : channel; }
};

} // namespace quadrant::inline v0::diagnosis::detail
