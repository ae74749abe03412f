// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/check_physics.hpp>
#include <quadrant/diagnosis/import/own_header.hpp>
#include <quadrant/diagnosis/import/propose_map.hpp>
#include <quadrant/diagnosis/import/read_map.hpp>
#include <quadrant/diagnosis/import_log.hpp>
#include <quadrant/diagnosis/read_log.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Logs from texts alone, for the page and for Python.
namespace quadrant_gap {
using namespace quadrant::diagnosis;

/// An import whose physics was checked, with its notes before those of the log.
inline imported_log checked(imported_log imported) {
    check_physics(imported);
    imported.log.notes.insert(imported.log.notes.begin(), imported.notes.begin(), imported.notes.end());
    return imported;
}

/// The map that a known program's header proposes, with what was guessed; none where no program is known.
/// Throws what the file does not say.
inline std::optional<std::pair<import_map, std::vector<std::string>>> guessed_map(const std::string& text,
                                                                                  const std::string& name) {
    const proposed_map proposed = propose_map(text, name);
    if (proposed.tool.empty()) return {};
    if (!proposed.open.empty()) {
        std::string open;
        for (const auto& each : proposed.open) open += (open.empty() ? "" : "; ") + each;
        throw bad_input(name, fmt::format("looks like a file of {}, which does not say: {}. Begin a map with "
                                          "\"import --propose FILE MAP.json\", put in what is missing, and "
                                          "import with --map",
                                          proposed.tool, open));
    }
    std::vector<std::string> notes{
        fmt::format("guessed from the header, as {} writes it: {}. Another map: --propose", proposed.tool,
                    proposed.said())};
    notes.insert(notes.end(), proposed.notes.begin(), proposed.notes.end());
    return std::pair{read_import_map(proposed.map().dump(), "the map that was guessed"), std::move(notes)};
}

/// A log from its text, as our own reader has it, or by the names and units of its columns, or as a program
/// that we know names them: `through(map, text)` then imports it. Throws the refusal of our own reader where
/// the columns have our names in SI.
template <class Import>
machine_log log_of_text(const std::string& text, const std::string& name, const Import& through) {
    std::optional<bad_input> refused;
    try {
        return quadrant::diagnosis::read_log_text(text, name);
    } catch (const bad_input& fault) {
        refused = fault;
    }
    std::optional<import_map> map;
    try {
        map = map_of_header(text, name);
    } catch (const bad_input&) {
        auto guessed = guessed_map(text, name);
        if (!guessed) throw *refused;
        machine_log log = through(guessed->first, text).log;
        log.notes.insert(log.notes.begin(), guessed->second.begin(), guessed->second.end());
        return log;
    }
    return through(*map, text).log;
}

} // namespace quadrant_gap
