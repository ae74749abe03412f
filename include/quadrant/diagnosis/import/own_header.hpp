// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/axis_name.hpp"
#include "foreign_lines.hpp"
#include "missing_column.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// The layout of a text whose first line names its columns: what separates them, and whether numbers have a
/// decimal comma.
inline import_map::layout layout_of(std::string_view text) {
    import_map::layout out;
    out.header_line = 1;
    const std::size_t end = text.find('\n');
    const std::string_view header = text.substr(0, end);
    for (const char c : {';', '\t'})
        if (header.find(c) != header.npos) out.separator = c;
    if (out.separator != ',' && end != text.npos) {
        const std::string_view row = text.substr(end + 1, text.find('\n', end + 1) - end - 1);
        if (row.find(',') != row.npos) out.decimal = ',';
    }
    return out;
}

/// Whether a column of this name is the time.
inline bool names_time(std::string_view name) {
    const std::size_t end = name.find_first_of("_ [(");
    const std::string_view word = name.substr(0, end);
    const unit_name* unit = unit_at_end(name);
    return (word == "t" || word == "time" || word == "Time") && unit && unit->si == "s";
}

/// The role, by the middle of a column's name and its unit, and the axis that stands before it.
inline std::optional<std::pair<std::string, signal_role>> named_signal(std::string_view name,
                                                                       const unit_name* unit) {
    for (const signal_role role :
         {signal_role::motor_position, signal_role::reference_velocity, signal_role::reference,
          signal_role::position, signal_role::command, signal_role::velocity, signal_role::current,
          signal_role::torque, signal_role::duty, signal_role::supply, signal_role::enabled}) {
        const signal_kind& kind = kind_of(role);
        const std::size_t at = name.rfind(kind.infix);
        if (at == name.npos || at == 0 || !is_axis_name(name.substr(0, at))) continue;
        const std::string si(unit ? unit_as(role, unit->si) : "1");
        const auto legal = [&](std::string_view units) {
            return (' ' + std::string(units) + ' ').find(' ' + si + ' ') != std::string::npos;
        };
        if (legal(kind.linear) || legal(kind.rotary)) return std::pair{std::string(name.substr(0, at)), role};
    }
    return {};
}

} // namespace detail

/// The map of a file whose columns have the names of our logs, in any unit and with any separator
/// ("t_ms;x_pos_mm;..."), from its first line. Columns of other names are left out. Refuses a file without a
/// time or without a position.
inline import_map map_of_header(std::string_view text, std::string_view file) {
    using namespace detail;
    text = without_byte_order_mark(text);
    import_map out;
    out.file = one_line(file);
    out.files = {layout_of(text)};
    foreign_lines lines(out.files[0], text, file);
    if (!lines.next()) throw bad_input(file, "is empty");
    if (text.starts_with('{') || text.starts_with("[{") || text.starts_with("[["))
        throw bad_input(file, "is JSON, no table: write time, position and command of one test as columns (CSV)");
    const auto& cells = lines.cells();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::string name(cells[i].text);
        const unit_name* unit = unit_at_end(name);
        import_map::source source{.column = name,
                                  .number = i + 1,
                                  .si = unit ? std::string(unit->si) : "1",
                                  .factor = unit ? unit->factor : 1,
                                  .place = "the column"};
        if (!out.files[0].time && names_time(name)) {
            out.files[0].time = source;
            continue;
        }
        const auto signal = named_signal(name, unit);
        if (!signal) {
            if (!name.empty()) out.left_out.push_back(name);
            continue;
        }
        if (unit) source.si = unit_as(signal->second, unit->si);
        auto axis = std::find_if(out.axes.begin(), out.axes.end(),
                                 [&](const auto& a) { return a.name == signal->first; });
        if (axis == out.axes.end()) axis = out.axes.insert(axis, {signal->first, {}, command_origin::asked});
        axis->signals.push_back({signal->second, source});
    }
    std::erase_if(out.axes, [](const auto& a) { return !a.find(signal_role::position); });
    const auto instead = [&] {
        std::vector<std::string> names;
        for (const auto& cell : cells)
            if (double number = 0; !cell.text.empty() && lines.parse(cell.text, number))
                names.emplace_back(cell.text);
        return ": say with --map which column is what (--propose FILE MAP.json begins a map)" +
               (names.empty() ? "" : "; there are " + some_of(names));
    };
    if (!out.files[0].time) lines.refuse(0, "no column t_s (or t_ms, t_us, \"time [ms]\")" + instead());
    if (out.axes.empty())
        lines.refuse(0, "no column such as x_pos_m or x_pos_rad (or x_pos_mm, x_pos_deg)" + instead());
    return out;
}

} // namespace quadrant::inline v0::diagnosis
