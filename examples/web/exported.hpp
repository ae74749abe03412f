// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant_gap/settings.hpp"

#include <quadrant/diagnosis/write_mjcf.hpp>

#include <nlohmann/json.hpp>

/// A machine as other programs take it: what the page saves, as quadrant-gap export does.
namespace quadrant_web {
using namespace quadrant::diagnosis;

/// The file, its type and what it cannot hold. `as`: linuxcnc, drive, compensation or mjcf.
inline nlohmann::json exported(const machine_description& machine, const machine_log& log,
                               const std::string& as) {
    const auto file = [](const char* name, const char* type, const std::string& text,
                         const std::vector<std::string>& notes) {
        return nlohmann::json{{"name", name}, {"type", type}, {"text", text}, {"notes", notes}};
    };
    if (as == "linuxcnc") {
        const auto lines = quadrant_gap::linuxcnc_lines(machine);
        return file("linuxcnc.txt", "text/plain", lines.text, lines.notes);
    }
    if (as == "drive") {
        const auto values = quadrant_gap::drive_values(machine);
        return file("drive.csv", "text/csv", values.text, values.notes);
    }
    if (as == "compensation") {
        const auto table = quadrant_gap::compensation_table(machine, quadrant_gap::travel_of(log));
        return file("corrections.csv", "text/csv", table.text, table.notes);
    }
    const auto model = to_mjcf(machine);
    return file("model.xml", "application/xml", model.xml, model.notes);
}

} // namespace quadrant_web
