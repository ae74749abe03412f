// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "foreign_lines.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What the header of another program's file says of its columns: a map to begin with.
struct proposed_map {
    /// One column of the file.
    struct column {
        std::string name;         ///< as the file has it; empty: it has no names
        std::size_t number;       ///< from 1
        std::string role, unit;   ///< keys of a map; empty: not known
        std::string axis = "x";   ///< of a signal
        bool time = false;        ///< the stamps
        bool is_measured = false; ///< a command taken behind the amplifier
    };
    std::string tool;               ///< that wrote the file; empty: not known
    nlohmann::json layout;          ///< the map's keys of the layout
    std::vector<column> columns;    ///< all of them
    std::vector<std::string> notes; ///< what was guessed, and by what
    std::vector<std::string> open;  ///< what the file does not say

    /// Where a map finds a column, and its unit; "?" where that is not known.
    nlohmann::json source_of(const column& c) const {
        nlohmann::json out = {{"unit", c.unit.empty() ? "?" : c.unit}};
        if (c.name.empty() || (!layout.contains("layout") && is_repeated(c.name)))
            out["column"] = c.number;
        else
            out["column"] = c.name;
        if (c.is_measured) out["is"] = "measured";
        return out;
    }
    /// As a map file. A unit that is not known is "?", which no reader of maps takes.
    nlohmann::json map() const {
        nlohmann::json out = layout;
        out["schema"] = "quadrant.import/1";
        for (const column& c : columns)
            if (c.time || !c.role.empty()) (c.time ? out["time"] : out["axes"][c.axis][c.role]) = source_of(c);
        return out;
    }
    /// Of the columns that have a meaning, in words.
    std::string said() const {
        std::string out;
        for (const column& c : columns)
            if (c.time || !c.role.empty())
                out += fmt::format(
                    "{}{} is {}{}{}", out.empty() ? "" : ", ",
                    c.name.empty() ? fmt::format("column {}", c.number) : detail::one_line(c.name),
                    c.time ? "the time" : fmt::format("the {} of {}", c.role, c.axis),
                    c.is_measured ? ", measured" : "", c.unit.empty() ? "" : fmt::format(" in {}", c.unit));
        return out;
    }

private:
    bool is_repeated(const std::string& name) const {
        return std::count_if(columns.begin(), columns.end(), [&](const column& c) { return c.name == name; }) >
               1;
    }
};

namespace detail {

/// Lines at the head of a file among which its columns are looked for.
inline constexpr std::size_t most_header_lines = 60;

/// A separator as a map says it.
inline std::string separator_key(char c) { return c == '\t' ? "tab" : c == ' ' ? "blanks" : std::string(1, c); }

/// The last part of a dotted path.
inline std::string_view leaf_of(std::string_view path) { return path.substr(path.rfind('.') + 1); }

/// A signal by the last part of its name, the best first.
struct known_signal {
    std::string_view leaf, role, unit;
    bool is_measured = false;
};

/// Gives roles to the columns of one axis: of each role the first of the list that is there. `member` says
/// which columns are of the axis.
template <class Member>
void give_roles(proposed_map& out, std::string_view axis, std::span<const known_signal> known,
                const Member& member) {
    for (const known_signal& k : known) {
        const auto has_role = [&](const proposed_map::column& c) { return c.axis == axis && c.role == k.role; };
        if (std::any_of(out.columns.begin(), out.columns.end(), has_role)) continue;
        std::vector<proposed_map::column*> found;
        for (auto& c : out.columns)
            if (!c.time && c.role.empty() && member(c) && leaf_of(c.name) == k.leaf) found.push_back(&c);
        if (found.size() > 1) {
            out.open.push_back(fmt::format("{} and {} may both be the {} of {}", found[0]->name, found[1]->name,
                                           k.role, axis));
            continue;
        }
        if (found.empty()) continue;
        auto& c = *found.front();
        c.role = k.role;
        c.axis = axis;
        if (c.unit.empty()) c.unit = k.unit;
        c.is_measured = k.is_measured;
    }
}

/// What a map needs and does not have.
inline void say_what_is_open(proposed_map& out) {
    std::vector<std::string> axes;
    for (const auto& c : out.columns)
        if (!c.role.empty() && std::find(axes.begin(), axes.end(), c.axis) == axes.end())
            axes.push_back(c.axis);
    const auto has = [&](const std::string& axis, std::string_view role) {
        return std::any_of(out.columns.begin(), out.columns.end(),
                           [&](const auto& c) { return c.axis == axis && c.role == role; });
    };
    std::string others; // columns without a meaning
    for (const auto& c : out.columns)
        if (!c.time && c.role.empty() && !c.name.empty())
            others += (others.empty() ? " (left out: " : ", ") + one_line(c.name);
    if (!others.empty()) others += ')';
    if (axes.empty()) out.open.push_back("which column is the position" + others);
    for (const std::string& axis : axes) {
        if (!has(axis, "position")) out.open.push_back(fmt::format("which column is the position of {}", axis));
        if (!has(axis, "command"))
            out.open.push_back(
                fmt::format("which column is the command of {}, in V, A, N or Nm, or a drive's set-points{}",
                            axis, others));
    }
    for (const auto& c : out.columns)
        if ((c.time || !c.role.empty()) && c.unit.empty())
            out.open.push_back(fmt::format("the unit of {}", c.name.empty() ? fmt::format("column {}", c.number)
                                                                            : one_line(c.name)));
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
