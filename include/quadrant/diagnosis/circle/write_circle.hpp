// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "result.hpp"

#include <nlohmann/json.hpp>

namespace quadrant::inline v0::diagnosis {

namespace detail {

inline nlohmann::ordered_json number_json(const circle_number& n) {
    return {{"value", n.value}, {"ci95", {n.low, n.high}}};
}

inline nlohmann::ordered_json circle_error_json(const circle_error& e) {
    nlohmann::ordered_json out{{"error", e.name}, {"axis", e.axis}, {"verdict", name_of(e.verdict)}};
    if (e.verdict == circle_verdict::found) {
        out["value"] = e.value.value, out["ci95"] = {e.value.low, e.value.high};
        out["unit"] = e.unit, out["positive_means"] = e.sign;
        out["circularity_m"] = e.circularity, out["share"] = e.share;
        out["effects"] = e.effects;
        if (e.period > 0) out[e.name == "vibration" ? "frequency_Hz" : "period_m"] = e.period;
        if (!e.reading.empty()) out["reading"] = e.reading;
    }
    if (e.verdict == circle_verdict::found || e.verdict == circle_verdict::below_limit) {
        out["detection_limit"] = e.limit;
        out["unit"] = e.unit;
    }
    if (!e.together_with.empty()) out["not_told_from"] = e.together_with;
    out["told_by"] = e.needs;
    for (const circle_detail& d : e.details) {
        nlohmann::ordered_json part{{"where", d.what}, {"feed_m_per_s", d.feed}, {"radius_m", d.radius}};
        part.update(number_json(d.size));
        if (d.width_s > 0) part["width_s"] = d.width_s;
        out["details"].push_back(part);
    }
    return out;
}

} // namespace detail

/// A ball-bar diagnosis as JSON (docs/schema/circle.schema.json); SI.
inline nlohmann::ordered_json to_json(const circle_result& r) {
    nlohmann::ordered_json runs = nlohmann::ordered_json::array(), errors = nlohmann::ordered_json::array();
    for (const circle_run_result& k : r.runs)
        runs.push_back({{"file", k.run.file},
                        {"start_s", k.run.start_s},
                        {"direction", k.run.counterclockwise ? "counterclockwise" : "clockwise"},
                        {"turns", k.run.turns},
                        {"feed_m_per_s", k.run.feed},
                        {"radius_m", k.run.radius},
                        {"circular_error_m", k.circular_error},
                        {"radial_max_m", k.radial_max},
                        {"radial_min_m", k.radial_min},
                        {"remaining_rms_m", k.remaining}});
    for (const circle_error& e : r.errors) errors.push_back(detail::circle_error_json(e));
    return {{"schema", "quadrant.circle/1"},
            {"source", r.source == circle_source::encoder ? "encoder" : "instrument"},
            {"axes", {r.first_axis, r.second_axis}},
            {"runs", runs},
            {"errors", errors},
            {"explained", r.explained},
            {"notes", r.notes}};
}

} // namespace quadrant::inline v0::diagnosis
