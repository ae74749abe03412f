// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/json_keys.hpp"

#include <algorithm>

namespace quadrant::inline v0::diagnosis {

namespace detail {

class import_map_reader {
public:
    import_map_reader(std::string_view text, std::string_view file)
        : root_(parse_json(text, file)), top_{&root_, "", file} {}

    import_map read() {
        constexpr std::string_view keys[] = {"schema", "comment", "separator", "decimal", "header",
                                             "end",    "layout",  "time",      "axes",    "files"};
        refuse_unknown_keys(top_.object(), keys);
        need_schema(top_, "quadrant.import/1");
        out_.file = one_line(top_.file);
        import_map::layout common;
        const auto files = top_.find("files");
        if (!files && !top_.find("layout") && names_a_column(root_)) common.header_line = 1;
        read_layout(top_, common);
        if (files) {
            if (!files->value->is_array() || files->value->empty())
                files->refuse("must be an array of layouts");
            out_.files.clear();
            for (const auto& entry : *files->value) {
                const json_node node{&entry, fmt::format("files[{}]", out_.files.size()), top_.file};
                constexpr std::string_view own[] = {"comment", "separator", "decimal", "header",
                                                    "end",     "layout",    "time"};
                refuse_unknown_keys(node.object(), own);
                out_.files.push_back(common);
                read_layout(node, out_.files.back());
            }
        } else {
            out_.files = {common};
        }
        for (const auto& file : out_.files)
            if (!file.time && file.period_s == 0 && !file.halscope) top_.need("time");
        each_axis(top_, [&](const std::string& name, const json_node& axis) {
            out_.axes.push_back(read_axis(name, axis));
        });
        return std::move(out_);
    }

private:
    /// Whether a column is given by its name anywhere in a map.
    static bool names_a_column(const nlohmann::json& node) {
        if (!node.is_structured()) return false;
        if (node.is_object() && node.contains("column") && node["column"].is_string()) return true;
        return std::any_of(node.begin(), node.end(), [](const auto& inner) { return names_a_column(inner); });
    }
    void read_layout(const json_node& node, import_map::layout& out) {
        if (const auto given = node.find("layout")) {
            if (given->text() != "halscope") given->refuse("must be \"halscope\", or left out");
            out.halscope = true;
        }
        if (const auto given = node.find("separator")) out.separator = separator(*given);
        if (const auto given = node.find("decimal")) {
            if (given->text() != "." && given->text() != ",") given->refuse("must be \".\" or \",\"");
            out.decimal = given->text()[0];
        }
        if (out.decimal == ',' && out.separator == ',' && !out.halscope)
            node.need("decimal").refuse("cannot be the separator of the columns too");
        if (const auto given = node.find("header")) read_header(*given, out);
        if (const auto given = node.find("end")) out.end = given->text();
        if (const auto given = node.find("time")) read_time(given->object(), out);
    }
    static char separator(const json_node& node) {
        const std::string& text = node.text();
        if (text == "tab") return '\t';
        if (text == "blanks") return ' ';
        if (text != "," && text != ";") node.refuse(R"(must be ",", ";", "tab" or "blanks")");
        return text[0];
    }
    static void read_header(const json_node& node, import_map::layout& out) {
        out.header_line = 0;
        out.header_begins_with.clear();
        if (node.value->is_string()) {
            out.header_begins_with = node.text();
            if (out.header_begins_with.empty()) node.refuse("must name the first cell of the line");
            return;
        }
        constexpr number_rule line{"must be the first cell of a line, or a line number from 1",
                                   [](double x) { return x >= 1 && x <= 1e6 && x == std::floor(x); }};
        out.header_line = static_cast<std::size_t>(node.number(line));
    }
    static void read_time(const json_node& node, import_map::layout& out) {
        out.time.reset();
        out.period_s = 0;
        if (out.halscope) node.refuse("stands in the first line of what halscope saves: leave it out");
        if (const auto period = node.find("period_s")) {
            constexpr std::string_view keys[] = {"period_s"};
            refuse_unknown_keys(node, keys);
            out.period_s = period->number(rule::positive);
        } else {
            for (const char* key : {"file", "is"})
                if (const auto given = node.find(key)) given->refuse("is for the signals of an axis");
            out.time = read_source(node, out);
            if (!out.time->si.empty() && out.time->si != "s")
                node.need("unit").refuse("must be a unit of time");
        }
    }
    static import_map::source read_source(const json_node& node, const import_map::layout& layout) {
        constexpr number_rule index{"must be the name of a column, or its number from 1",
                                    [](double x) { return x >= 1 && x <= 1e4 && x == std::floor(x); }};
        constexpr number_rule not_zero{"must be a number, not 0", [](double x) { return x != 0; }};
        constexpr number_rule element{"must be the place of a number in the list, from 1",
                                      [](double x) { return x >= 1 && x <= 1e4 && x == std::floor(x); }};
        constexpr std::string_view keys[] = {"column", "element", "unit", "scale", "file", "is"};
        refuse_unknown_keys(node.object(), keys);
        import_map::source s;
        s.place = node.path;
        if (const auto given = node.find("element"))
            s.element = static_cast<std::size_t>(given->number(element));
        const json_node column = node.need("column");
        if (!column.value->is_string())
            s.number = static_cast<std::size_t>(column.number(index));
        else if (!layout.named())
            column.refuse(
                "names a column, but the map has no header line: give its number, or \"header\": 1 where the "
                "first line has the names, as of a MAT-file");
        else
            s.column = column.text();
        if (const auto unit = node.find("unit"))
            take_unit(*unit, s);
        else if (const unit_name* known = unit_at_end(s.column))
            take(*known, s);
        else
            node.need("unit");
        if (const auto scale = node.find("scale")) s.factor *= scale->number(not_zero);
        return s;
    }
    static void take(const unit_name& unit, import_map::source& s) {
        s.si = unit.si;
        s.factor = unit.factor;
    }
    static void take_unit(const json_node& unit, import_map::source& s) {
        const unit_name* known = find_unit(unit.text());
        if (!known) {
            constexpr auto names = names_of(unit_names);
            unit.refuse(
                fmt::format("{} is not a unit that this program knows{}; for counts, give a scale and a unit",
                            in_quotes(unit.text()), suggestion(unit.text(), names)));
        }
        take(*known, s);
    }
    import_map::source read_signal(const json_node& node) const {
        constexpr number_rule file_rule{"must be the number of a file, from 1",
                                        [](double x) { return x >= 1 && x <= 100 && x == std::floor(x); }};
        std::size_t file = 0;
        if (const auto given = node.object().find("file")) {
            file = static_cast<std::size_t>(given->number(file_rule)) - 1;
            if (file >= out_.files.size())
                given->refuse(fmt::format("the map describes {} under files", out_.files.size()));
        }
        import_map::source s = read_source(node, out_.files[file]);
        s.file = file;
        return s;
    }
    import_map::axis read_axis(const std::string& name, const json_node& node) const {
        constexpr auto keys = [] {
            std::array<std::string_view, signal_kinds.size()> out;
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = signal_kinds[i].key;
            return out;
        }();
        refuse_unknown_keys(node, keys);
        import_map::axis a{name, {}, command_origin::asked};
        // Without a position the integral of the velocity stands for it.
        const bool placed = node.find("position") || !node.find("velocity");
        const json_node moves = placed ? node.need("position") : node.need("velocity");
        const auto motion = read_signal(moves);
        const bool rotary = motion.si == (placed ? "rad" : "rad_per_s");
        if (!rotary && motion.si != (placed ? "m" : "m_per_s"))
            moves.find("unit").value_or(moves).refuse(placed ? "must be a length or an angle"
                                                             : "must be a speed, of a length or of an angle");
        const bool only_positions = node.find("reference") || node.find("motor_position");
        if (!node.find("current") && !node.find("torque") && !only_positions) node.need("command");
        for (const signal_kind& kind : signal_kinds) {
            const auto given = node.find(std::string(kind.key));
            if (!given) continue;
            if (const auto is = given->object().find("is")) {
                if (kind.role != signal_role::command) is->refuse("is for a command only");
                if (is->text() != "asked" && is->text() != "measured")
                    is->refuse(R"(must be "asked" or "measured")");
                if (is->text() == "measured") a.command_is = command_origin::measured;
            }
            a.signals.push_back({kind.role, read_signal(*given)});
            std::string& si = a.signals.back().from.si;
            si = unit_as(kind.role, si);
            need_unit(*given, kind, si, rotary);
            if (kind.role == signal_role::command && is_set_point(si) &&
                a.command_is == command_origin::measured)
                given->refuse("is a set-point: it is asked for, not measured");
        }
        return a;
    }
    static void need_unit(const json_node& node, const signal_kind& kind, const std::string& si, bool rotary) {
        const std::string_view legal = rotary ? kind.rotary : kind.linear;
        for (std::size_t at = 0; at < legal.size();) {
            const std::size_t end = std::min(legal.find(' ', at), legal.size());
            if (legal.substr(at, end - at) == si) return;
            at = end + 1;
        }
        const json_node fault = node.find("unit").value_or(node);
        if (kind.role == signal_role::reference)
            fault.refuse("must be of the same kind as that of the position");
        if (kind.role == signal_role::command)
            fault.refuse(rotary ? "must be of V, A, Nm or duty (set-points of a drive: of rad/s or rad)"
                                : "must be of V, A, N or duty (set-points of a drive: of m/s or m)");
        std::string text(legal);
        for (auto at = text.find("_per_"); at != text.npos; at = text.find("_per_")) text.replace(at, 5, "/");
        fault.refuse("must be a unit that gives " + text);
    }

    nlohmann::json root_;
    json_node top_;
    import_map out_{};
};

} // namespace detail

QUADRANT_DIAGNOSIS_DECL import_map read_import_map(std::string_view text, std::string_view name) {
    return detail::import_map_reader(text, name).read();
}
QUADRANT_DIAGNOSIS_DECL import_map read_import_map(const std::filesystem::path& path) {
    return read_import_map(detail::read_whole(path), path.string());
}

} // namespace quadrant::inline v0::diagnosis
