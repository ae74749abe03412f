// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/check_physics.hpp>
#include <quadrant/diagnosis/import/own_header.hpp>
#include <quadrant/diagnosis/import_log.hpp>
#include <quadrant/diagnosis/read_log.hpp>

#include <optional>
#include <string>
#include <utility>

/// Logs from texts alone, for the page and for Python.
namespace quadrant_gap {
using namespace quadrant::diagnosis;

/// An import whose physics was checked, with its notes before those of the log.
inline imported_log checked(imported_log imported) {
    check_physics(imported);
    imported.log.notes.insert(imported.log.notes.begin(), imported.notes.begin(), imported.notes.end());
    return imported;
}

/// A log from its text, as our own reader has it, or by the names and units of its columns: `through(map,
/// text)` then imports it. Throws the refusal of our own reader where the columns have our names in SI.
template <class Import>
machine_log log_of_text(const std::string& text, const std::string& name, const Import& through) {
    std::optional<bad_input> refused;
    try {
        return quadrant::diagnosis::detail::log_reader(text, name).read();
    } catch (const bad_input& fault) {
        refused = fault;
    }
    std::optional<import_map> map;
    try {
        map = map_of_header(text, name);
    } catch (const bad_input&) {
        throw *refused;
    }
    return through(*map, text).log;
}

} // namespace quadrant_gap
