// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "simulate.hpp"
#include "write_diagnosis.hpp"

namespace quadrant::inline v0::diagnosis {

/// What a simulation leaves, as JSON (docs/schema/simulation.schema.json).
inline nlohmann::ordered_json to_json(const simulation_result& s) {
    nlohmann::ordered_json axes = nlohmann::ordered_json::object();
    for (const simulated_axis& a : s.axes) {
        nlohmann::ordered_json where = nlohmann::ordered_json::array();
        for (const place& p : a.where) where.push_back(detail::place_json(p));
        axes[a.name] = {{"kind", name_of(a.kind)},
                        {"closed_loop", a.closed_loop},
                        {"command_unit", a.command_unit},
                        {"gap", detail::gap_json(a.gap, a.kind)},
                        {"where", where}};
    }
    nlohmann::ordered_json out = {{"schema", "quadrant.simulation/1"}, {"axes", axes}, {"notes", s.notes}};
    auto files =
        detail::files_json({{"machine", s.machine_file, s.machine_sha256}, {"log", s.log_file, s.log_sha256}});
    if (!files.empty()) out["files"] = std::move(files);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
