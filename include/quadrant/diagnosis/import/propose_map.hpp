// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/axis_name.hpp"
#include "any_table.hpp"
#include "halscope_file.hpp"
#include "twincat_header.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// ODrive's GUI (Export): "time" [s], then property paths without the name of the board. Units by the
/// firmware's interface: turns and N m, from 0.5 on (0.4 had counts).
inline bool propose_odrive(proposed_map& out, std::string_view text, std::string_view file) {
    import_map::layout layout;
    foreign_lines lines(layout, text, file);
    if (!lines.next() || !lines.begins_with("time")) return false;
    std::vector<std::string> axes;
    const auto axis_in = [](std::string_view path) { // "axis0" of "axis0.encoder.pos_estimate"
        const std::size_t at = path.find("axis");
        if (at == path.npos || (at > 0 && path[at - 1] != '.')) return std::string_view();
        const std::string_view name = path.substr(at, path.find('.', at) - at);
        return is_axis_name(name) && name.find_first_of("0123456789") != name.npos ? name : std::string_view();
    };
    for (const auto& cell : lines.cells()) {
        out.columns.push_back(
            {.name = std::string(cell.text), .number = out.columns.size() + 1, .role = {}, .unit = {}});
        const std::string axis(axis_in(cell.text));
        if (!axis.empty() && std::find(axes.begin(), axes.end(), axis) == axes.end()) axes.push_back(axis);
    }
    if (axes.empty()) return false;
    out.columns[0].time = true;
    out.columns[0].unit = "s";
    out.tool = "ODrive";
    out.layout = {{"separator", ","}, {"header", 1}};
    static constexpr known_signal known[] = {
        {"pos_estimate", "position", "turn"}, {"pos_setpoint", "reference", "turn"},
        {"input_pos", "reference", "turn"},   {"effective_torque_setpoint", "command", "Nm"},
        {"Iq_setpoint", "command", "A"},      {"Iq_measured", "command", "A", true},
    };
    for (const std::string& axis : axes)
        give_roles(out, axis, known, [&](const auto& c) { return axis_in(c.name) == axis; });
    for (const auto& c : out.columns)
        if (c.role.empty() && leaf_of(c.name) == "torque_setpoint")
            out.notes.push_back(
                fmt::format("{} is left out: with a position or velocity loop it is the feedforward alone",
                            one_line(c.name)));
    say_what_is_open(out);
    out.notes.emplace_back("positions in turns, as in ODrive's firmware from 0.5 on");
    return true;
}

/// LinuxCNC's halscope. The names are pins of HAL; machine units may be mm or inches.
inline bool propose_halscope(proposed_map& out, std::string_view text, std::string_view file) {
    const import_map::layout layout = halscope_file::layout_of({}, text);
    foreign_lines lines(layout, text, file);
    const auto scope = halscope_file::read(lines, layout);
    if (!scope) return false;
    for (std::size_t i = 0; i < scope->names.size(); ++i)
        out.columns.push_back({.name = scope->names[i], .number = i + 1, .role = {}, .unit = {}});
    out.tool = "halscope";
    out.layout = {{"layout", "halscope"}};
    static constexpr known_signal known[] = {
        {"motor-pos-fb", "position", ""}, {"feedback", "position", ""}, {"motor-pos-cmd", "reference", ""},
        {"command", "reference", ""},     {"output", "command", ""},
    };
    give_roles(out, "x", known, [](const auto&) { return true; });
    say_what_is_open(out);
    return true;
}

/// LinuxCNC's halsampler: numbers between blanks, without any name; with -t the sample's number first.
inline bool propose_halsampler(proposed_map& out, std::string_view text, std::string_view file) {
    import_map::layout layout;
    layout.separator = ' ';
    foreign_lines lines(layout, text, file);
    std::vector<double> counts;
    constexpr std::size_t looked_at = 20;
    for (std::size_t k = 0; k < looked_at && lines.next(); ++k) {
        const auto& cells = lines.cells();
        double number = 0;
        if (cells.size() < 2 || (k > 0 && cells.size() != out.columns.size())) return false;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (lines.parse(cells[i].text, number)) return false;
            if (k == 0) out.columns.push_back({.name = "", .number = i + 1, .role = {}, .unit = {}});
            if (i == 0) counts.push_back(number);
        }
    }
    if (counts.size() < 2) return false;
    bool counted = true;
    for (std::size_t k = 1; k < counts.size(); ++k) counted = counted && counts[k] == counts[k - 1] + 1;
    out.tool = "halsampler";
    out.layout = {{"separator", "blanks"}};
    if (counted) {
        out.columns[0].time = true;
        out.notes.emplace_back("column 1 counts the samples (halsampler -t)");
        out.open.emplace_back(
            "the period of sampler's thread (\"time\": {\"column\": 1, \"unit\": \"ms\", \"scale\": 1} "
            "for 1 ms)");
    } else {
        out.layout["time"] = {{"period_s", "?"}};
        out.open.emplace_back("the period of sampler's thread (\"time\": {\"period_s\": 0.001} for 1 ms)");
    }
    out.open.emplace_back("which column is what, by the order of the pins of sampler, and their units");
    return true;
}

} // namespace detail

/// What the first lines of a file say of its columns: of a program that we know as it writes them, of any other
/// table (`tool` is empty then) by the words of the names. No role is guessed from numbers: a column whose name
/// does not say what it is stays open. No columns: this is no table.
inline proposed_map propose_map(std::string_view text, std::string_view file) {
    for (const auto propose :
         {detail::propose_odrive, detail::twincat_header::propose, detail::propose_halscope,
          detail::propose_halsampler, detail::any_table::propose}) {
        proposed_map out;
        try {
            if (propose(out, text, file)) return out;
        } catch (const bad_input&) { // a quote that is not closed: the reader says so in its place
        }
    }
    return {};
}

} // namespace quadrant::inline v0::diagnosis
