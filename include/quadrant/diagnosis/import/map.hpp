// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../read/json_keys.hpp"
#include "units.hpp"

namespace quadrant::diagnosis {

/// Which column of another program's log is what (docs/schema/import.schema.json).
struct import_map {
    /// Where one quantity is found in a file, and what makes it SI.
    struct source {
        std::string column;     ///< its name; empty: by number
        std::size_t number = 0; ///< from 1
        std::string si;         ///< unit of the converted column
        double factor = 1;      ///< SI per unit of the file
        std::string place;      ///< key path in the map, for messages
    };
    /// The three columns of one axis.
    struct axis {
        std::string name;
        source reference, position, command;
    };
    std::string file;
    char separator = ','; ///< ' ': any run of blanks
    char decimal = '.';
    std::size_t header_line = 0;    ///< from 1; 0: by `header_begins_with`, or none
    std::string header_begins_with; ///< first cell of the line that names the columns
    std::string end;                ///< a line of this text ends the rows
    std::optional<source> time;
    double period_s = 0; ///< without a time column
    std::vector<axis> axes;
    bool named() const { return header_line > 0 || !header_begins_with.empty(); }
};

namespace detail {

class import_map_reader {
public:
    import_map_reader(std::string_view text, std::string_view file)
        : root_(parse_json(text, file)), top_{&root_, "", file} {}

    import_map read() {
        constexpr std::string_view keys[] = {"schema", "comment", "separator", "decimal",
                                             "header", "end",     "time",      "axes"};
        refuse_unknown_keys(top_.object(), keys);
        need_schema(top_, "quadrant.import/1");
        out_.file = one_line(top_.file);
        if (const auto given = top_.find("separator")) out_.separator = separator(*given);
        if (const auto given = top_.find("decimal")) {
            if (given->text() != "." && given->text() != ",") given->refuse("must be \".\" or \",\"");
            out_.decimal = given->text()[0];
        }
        if (out_.decimal == ',' && out_.separator == ',')
            top_.need("decimal").refuse("cannot be the separator of the columns too");
        if (const auto given = top_.find("header")) read_header(*given);
        if (const auto given = top_.find("end")) out_.end = given->text();
        read_time(top_.need("time").object());
        each_axis(top_, [&](const std::string& name, const json_node& axis) {
            out_.axes.push_back(read_axis(name, axis));
        });
        return std::move(out_);
    }

private:
    static char separator(const json_node& node) {
        const std::string& text = node.text();
        if (text == "tab") return '\t';
        if (text == "blanks") return ' ';
        if (text != "," && text != ";") node.refuse(R"(must be ",", ";", "tab" or "blanks")");
        return text[0];
    }
    void read_header(const json_node& node) {
        if (node.value->is_string()) {
            out_.header_begins_with = node.text();
            if (out_.header_begins_with.empty()) node.refuse("must name the first cell of the line");
            return;
        }
        constexpr number_rule line{"must be the first cell of a line, or a line number from 1",
                                   [](double x) { return x >= 1 && x <= 1e6 && x == std::floor(x); }};
        out_.header_line = static_cast<std::size_t>(node.number(line));
    }
    void read_time(const json_node& node) {
        if (const auto period = node.find("period_s")) {
            constexpr std::string_view keys[] = {"period_s"};
            refuse_unknown_keys(node, keys);
            out_.period_s = period->number(rule::positive);
        } else {
            out_.time = read_source(node);
            if (out_.time->si != "s") node.need("unit").refuse("must be a unit of time");
        }
    }
    import_map::source read_source(const json_node& node) const {
        constexpr std::string_view keys[] = {"column", "unit", "scale"};
        constexpr number_rule index{"must be the name of a column, or its number from 1",
                                    [](double x) { return x >= 1 && x <= 1e4 && x == std::floor(x); }};
        constexpr number_rule not_zero{"must be a number, not 0", [](double x) { return x != 0; }};
        refuse_unknown_keys(node.object(), keys);
        import_map::source s;
        s.place = node.path;
        const json_node column = node.need("column");
        if (!column.value->is_string())
            s.number = static_cast<std::size_t>(column.number(index));
        else if (!out_.named())
            column.refuse("names a column, but the map has no header line: give its number");
        else
            s.column = column.text();
        const json_node unit = node.need("unit");
        const unit_name* known_unit = find_unit(unit.text());
        if (!known_unit) {
            constexpr auto names = names_of(unit_names);
            unit.refuse(fmt::format("{} is not a unit of this program{}; a count is scale times a unit",
                                    in_quotes(unit.text()), suggestion(unit.text(), names)));
        }
        s.si = known_unit->si;
        s.factor = known_unit->factor;
        if (const auto scale = node.find("scale")) s.factor *= scale->number(not_zero);
        return s;
    }
    import_map::axis read_axis(const std::string& name, const json_node& node) const {
        constexpr std::string_view keys[] = {"reference", "position", "command"};
        refuse_unknown_keys(node, keys);
        import_map::axis a{name, read_source(node.need("reference")), read_source(node.need("position")),
                           read_source(node.need("command"))};
        const bool rotary = a.position.si == "rad";
        if (a.position.si != "m" && !rotary)
            node.need("position").need("unit").refuse("must be a length or an angle");
        if (a.reference.si != a.position.si)
            node.need("reference").need("unit").refuse("must be of the same kind as that of the position");
        const std::string& u = a.command.si;
        if (u != "V" && u != "A" && u != (rotary ? "Nm" : "N"))
            node.need("command").need("unit").refuse(rotary ? "must be of V, A or Nm" : "must be of V, A or N");
        return a;
    }

    nlohmann::json root_;
    json_node top_;
    import_map out_{};
};

} // namespace detail

/// Reads a map or throws bad_input.
inline import_map read_import_map(std::string_view text, std::string_view name) {
    return detail::import_map_reader(text, name).read();
}
inline import_map read_import_map(const std::filesystem::path& path) {
    return read_import_map(detail::read_whole(path), path.string());
}

} // namespace quadrant::diagnosis
