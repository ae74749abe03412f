// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant_gap/log_of_text.hpp"

#include <quadrant/diagnosis/import/read_map.hpp>
#include <quadrant/diagnosis/import/table_file.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <nlohmann/json.hpp>

/// What was dropped on the page: a machine file, a log, a map, or a table whose columns have to be named first.
namespace quadrant_web {
using namespace quadrant::diagnosis;

/// A log that was read, as the page shows it.
inline nlohmann::json described(const machine_log& log) {
    nlohmann::json axes = nlohmann::json::array();
    for (const axis_log& a : log.axes)
        axes.push_back({{"name", a.name},
                        {"rotary", a.kind == axis_kind::rotary},
                        {"command_unit", a.command_unit},
                        {"has_reference", a.has_reference},
                        {"still", a.still}});
    return {{"kind", "log"},
            {"rows", log.samples},
            {"period_s", log.sample_period_s},
            {"axes", axes},
            {"notes", log.notes}};
}

/// The columns of a table that names none of our columns, and what can be guessed of each. Without names they
/// go by number.
inline nlohmann::json columns_of(const std::string& text, const std::string& name) {
    nlohmann::json columns = nlohmann::json::array(), units = nlohmann::json::array(),
                   roles = nlohmann::json::array();
    for (const unit_name& u : unit_names) units.push_back(u.name);
    for (const signal_kind& k : signal_kinds) roles.push_back(k.key);
    const proposed_map known = propose_map(text, name);
    for (const auto& c : known.columns)
        columns.push_back({{"name", c.name},
                           {"column", known.source_of(c).at("column")},
                           {"unit", c.unit},
                           {"time", c.time},
                           {"role", c.is_measured ? "measured" : c.role},
                           {"axis", c.axis}});
    return {{"columns", columns}, {"layout", known.layout}, {"units", units},
            {"roles", roles},     {"open", known.open},     {"tool", known.tool}};
}

/// A log, by our own reader or through a map; with jittering stamps on an even clock.
inline imported_log imported(const import_map& map, const std::vector<foreign_file>& files) {
    try {
        return quadrant_gap::checked(import_log(map, files));
    } catch (const bad_input&) {
        // or this refusal, which says why
        return quadrant_gap::checked(import_log(map, files, {.resample = true}));
    }
}

/// A log from its text alone.
inline machine_log read_dropped_log(const std::string& text, const std::string& name) {
    return quadrant_gap::log_of_text(text, name, [&](const import_map& map, const std::string& table) {
        return imported(map, {{table, name}});
    });
}

/// The schema that a JSON text names; empty: none, or no JSON.
inline std::string schema_of(const std::string& text) {
    const auto json = nlohmann::json::parse(detail::without_byte_order_mark(text), nullptr, false);
    return json.is_object() && json.contains("schema") && json["schema"].is_string()
               ? json["schema"].get<std::string>()
               : "";
}

inline bool looks_like_json(const std::string& text) {
    const auto first = detail::without_byte_order_mark(text).find_first_not_of(" \t\r\n");
    return first != std::string::npos && detail::without_byte_order_mark(text)[first] == '{';
}

} // namespace quadrant_web
