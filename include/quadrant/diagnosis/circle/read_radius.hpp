// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/sample_clock.hpp"
#include "../text/csv_cells.hpp"
#include "../text/decimal.hpp"
#include "../text/text.hpp"
#include "run.hpp"

#include <array>

namespace quadrant::inline v0::diagnosis {

namespace detail {

inline constexpr std::array radius_columns{std::string_view("t_s"), std::string_view("angle_deg"),
                                           std::string_view("radius_m"), std::string_view("nominal_radius_m")};

/// The columns of an instrument's file, in the order of `radius_columns`, and the step in which the radius was
/// written.
struct radius_table {
    std::array<std::vector<double>, 4> columns;
    written_step step;
};

template <class Refuse> radius_table read_radius_table(std::string_view text, Refuse refuse) {
    radius_table out;
    std::array<std::size_t, 4> place{};
    place.fill(std::string_view::npos);
    for (std::size_t number = 1, from = 0; from < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', from), text.size());
        std::string_view line = text.substr(from, end - from);
        if (line.ends_with('\r')) line.remove_suffix(1);
        from = end + 1;
        std::array<bool, 4> seen{};
        std::size_t index = 0;
        for (csv_cells cells(line); cells.next(); ++index) {
            if (cells.broken())
                refuse(number, line, cells.offset(), "a quote is not closed before the comma or the end");
            for (std::size_t c = 0; c < 4; ++c) {
                if (number == 1 && cells.text() == radius_columns[c]) place[c] = index;
                if (number == 1 || place[c] != index) continue;
                double value = 0;
                if (const char* fault = parse_number(cells.text(), value))
                    refuse(number, line, cells.offset(),
                           fmt::format("{}: {} {}", radius_columns[c], in_quotes(cells.text()), fault));
                if (c >= 2 && !(value > 0))
                    refuse(number, line, cells.offset(), fmt::format("{} must be above 0", radius_columns[c]));
                out.columns[c].push_back(value), seen[c] = true;
                if (c == 2) out.step.add(cells.text(), value);
            }
        }
        for (std::size_t c = 0; c < 4; ++c) {
            if (number == 1 && place[c] == std::string_view::npos)
                refuse(number, line, line.size(), fmt::format("column {} is missing", radius_columns[c]));
            if (number > 1 && !seen[c])
                refuse(number, line, line.size(), fmt::format("the row ends before {}", radius_columns[c]));
        }
    }
    return out;
}

} // namespace detail

/// Whether a file's header is that of an instrument's file.
inline bool is_radius_file(std::string_view text) {
    const std::string_view line = detail::without_byte_order_mark(text).substr(0, text.find('\n'));
    for (detail::csv_cells cells(line); cells.next();)
        if (cells.text() == "radius_m") return true;
    return false;
}

/// A file of a ball-bar or grid plate: CSV with `t_s`, `angle_deg` (from x towards y, rising or falling, with
/// or without jumps of 360), `radius_m` (as measured) and `nominal_radius_m`, other columns ignored. A run ends
/// where the angle turns back or the nominal radius changes; several runs may follow each other. Throws
/// bad_input with line and column.
inline std::vector<circle_run> read_radius(std::string_view text, std::string_view file,
                                           std::size_t number = 0) {
    text = detail::without_byte_order_mark(text);
    text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    const auto refuse = [&](std::size_t line, std::string_view row, std::size_t offset,
                            std::string_view message) {
        throw bad_input(file, line, detail::characters(row.substr(0, offset)) + 1, message);
    };
    const auto table = detail::read_radius_table(text, refuse);
    const auto &t = table.columns[0], &degrees = table.columns[1], &radius = table.columns[2],
               &nominal = table.columns[3];
    if (t.size() < 100)
        throw bad_input(file, fmt::format("holds {} samples, a circle needs 100 or more", t.size()));
    const double period = detail::read_even_clock(t, [&](std::size_t k, std::string_view message) {
                              refuse(k + 2, "", 0, message);
                          }).period;

    std::vector<double> angle;
    for (const double d : degrees) {
        const double a = d * std::numbers::pi / 180;
        angle.push_back(angle.empty() ? a : detail::unwrapped(a, angle.back()));
    }
    std::vector<circle_run> runs;
    const auto add = [&](std::size_t first, std::size_t last) {
        const auto at = [](const std::vector<double>& v, std::size_t k) {
            return v.begin() + static_cast<std::ptrdiff_t>(k);
        };
        circle_run r;
        r.angle.assign(at(angle, first), at(angle, last));
        first += detail::cut_to_whole_turns(r.angle, r.turns);
        if (r.turns == 0) return;
        r.angle.assign(at(angle, first), at(angle, last));
        r.file = detail::one_line(file), r.log = number, r.source = circle_source::instrument;
        r.period_s = period, r.start_s = double(first) * period;
        r.radius = nominal[first], r.resolution = table.step.step();
        const double turned = angle[last - 1] - angle[first];
        r.counterclockwise = turned > 0;
        r.feed = r.radius * std::abs(turned) / (double(last - first - 1) * period);
        for (std::size_t k = first; k < last; ++k) r.deviation.push_back(radius[k] - nominal[k]);
        runs.push_back(std::move(r));
    };
    std::size_t first = 0, farthest = 0; // of the run at hand: its first sample, and how far it has got
    for (std::size_t k = 1; k < angle.size(); ++k) {
        const double way = angle[farthest] - angle[first];
        const bool on = way >= 0 ? angle[k] >= angle[farthest] : angle[k] <= angle[farthest];
        const bool back = std::abs(angle[farthest] - angle[k]) > 0.05;
        const bool other = nominal[k] != nominal[k - 1];
        if (other || (back && !on)) {
            if (std::abs(way) > 0.05) add(first, other ? k : farthest + 1);
            first = other ? k : farthest, farthest = k;
        } else if (on) {
            farthest = k;
        }
    }
    add(first, angle.size());
    if (runs.empty()) throw bad_input(file, "holds no whole turn one way round");
    return runs;
}

} // namespace quadrant::inline v0::diagnosis
