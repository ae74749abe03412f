// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "compensate.hpp"
#include "write_diagnosis.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

inline nlohmann::ordered_json tracking_json(const tracking& t, bool measured, axis_kind kind) {
    nlohmann::ordered_json out;
    const auto put = [&](const char* key, const estimate& e) {
        if (measured)
            out[key] = e.value;
        else
            out[key] = {{"value", e.value}, {"range", interval_json(e)}};
    };
    put(key_of("rms_m", kind).c_str(), t.rms_m);
    put(key_of("peak_m", kind).c_str(), t.peak_m);
    put(key_of("glitch_m", kind).c_str(), t.glitch_m);
    put("command_rms_V", t.command_rms_V);
    return out;
}
inline nlohmann::ordered_json keys_json(const std::vector<key_value>& keys) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const key_value& k : keys) {
        if (k.values.size() == 1)
            out[k.key] = k.values[0];
        else
            out[k.key] = k.values;
    }
    return out;
}
inline nlohmann::ordered_json compensation_json(const compensation& c, bool forecast, axis_kind kind) {
    nlohmann::ordered_json out{{"name", c.name},
                               {"effects", c.effects},
                               {"block", c.block},
                               {"settings", keys_json(c.settings)},
                               {"controller", keys_json(c.keys)}};
    if (!forecast) return out;
    out["after"] = tracking_json(c.after, false, kind);
    out["gain"] = {{"value", c.gain.value}, {"range", interval_json(c.gain)}};
    out["gain_at_ends"] = c.gain_at_ends;
    out["claimed"] = c.claimed;
    return out;
}

} // namespace detail

/// What compensations would gain, as JSON (docs/schema/compensation.schema.json).
inline nlohmann::ordered_json to_json(const compensation_result& r) {
    nlohmann::ordered_json axes = nlohmann::ordered_json::object();
    for (const compensated_axis& a : r.axes) {
        auto& out = axes[a.name] = {{"command_unit", a.command_unit}, {"forecast", a.forecast}};
        if (a.forecast) {
            out["measured"] = detail::tracking_json(a.measured, true, a.kind);
            out[key_of("missed_rms_m", a.kind)] = a.missed_rms_m;
            out[key_of("noise_m", a.kind)] = a.noise_m;
        }
        out["compensations"] = nlohmann::ordered_json::array();
        for (const compensation& c : a.compensations)
            out["compensations"].push_back(detail::compensation_json(c, a.forecast, a.kind));
        out["others"] = nlohmann::ordered_json::array();
        for (const advice& o : a.others) out["others"].push_back({{"effect", o.effect}, {"advice", o.text}});
    }
    return {{"schema", "quadrant.compensation/1"}, {"axes", axes}, {"notes", r.notes}};
}

/// What of it the machine file's controller has keys for, where a gain is claimed: a merge patch (RFC 7386) to
/// the machine file. Friction feedforwards that need a block are not in it.
inline nlohmann::ordered_json controller_patch(const compensation_result& r) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const compensated_axis& a : r.axes)
        for (const compensation& c : a.compensations)
            if (c.claimed && c.by_keys())
                for (const key_value& k : c.keys) out["axes"][a.name]["controller"][k.key] = k.values[0];
    return out;
}

} // namespace quadrant::inline v0::diagnosis
