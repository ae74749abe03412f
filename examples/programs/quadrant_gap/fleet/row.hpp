// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../words.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace quadrant_gap::fleet {

/// An effect that is claimed of a log, with what it makes and its first value.
struct finding {
    std::string axis, effect, key, unit = "N";
    double value = 0, low = 0, high = 0;
    double force = 0, floor = 0; ///< rms of what it takes off the residual; of sensor and rounding [unit]
};

/// One log in the overview.
struct row {
    std::string name;
    std::string verdict = "not_done"; ///< of the diagnosis; "failed"; "not_done"
    std::string error;
    std::string axis,
        cause; ///< of the first claim or suspect; without one, the axis with the largest gap in force
    bool claimed = false;
    double probability = 0, shrink = 0;
    double force_before_N = 0, force_after_N = 0, position_rms_m = 0; ///< of that axis
    std::vector<std::string> claims;                                  ///< every effect that is claimed, once
    std::string unit = "N", length = "m";                             ///< of that axis
    std::string machine;                                              ///< digest of its machine file
    std::vector<finding> findings;                                    ///< what is claimed, axis by axis
};

/// Verdicts as the overview lists them: what asks for attention first.
inline constexpr std::string_view verdicts[] = {
    "failed", "unexplained", "partly_explained", "explained", "within_tolerance", "no_gap", "not_done"};

inline row failed_row(std::string name, std::string error) {
    row out;
    out.name = std::move(name);
    out.verdict = "failed";
    out.error = std::move(error);
    return out;
}

namespace detail {

/// A number under the key of its axis, linear or rotary.
inline double number_of(const nlohmann::ordered_json& box, const char* linear_key,
                        quadrant::diagnosis::axis_kind kind) {
    return box.at(quadrant::diagnosis::key_of(linear_key, kind));
}
inline quadrant::diagnosis::axis_kind kind_of(const nlohmann::ordered_json& axis) {
    using quadrant::diagnosis::axis_kind;
    return axis.value("kind", "linear") == "rotary" ? axis_kind::rotary : axis_kind::linear;
}

/// What a claim says, for the comparison with sisters.
inline finding finding_of(const nlohmann::ordered_json& cause, const nlohmann::ordered_json& axis) {
    const auto kind = kind_of(axis);
    finding f{.axis = cause.at("axis"), .effect = cause.at("effect"), .key = {}};
    const bool positions = axis.value("positions_only", false);
    const char *before = positions ? "gap_before_position_rms_m" : "gap_before_force_rms_N",
               *after = positions ? "gap_after_position_rms_m" : "gap_after_force_rms_N";
    const bool turns = kind == quadrant::diagnosis::axis_kind::rotary;
    f.unit = positions ? (turns ? "rad" : "m") : (turns ? "N m" : "N");
    const double b = number_of(cause, before, kind), a = number_of(cause, after, kind);
    f.force = std::sqrt(std::max(0.0, b * b - a * a));
    f.floor = positions ? 0 : number_of(axis.at("gap"), "noise_floor_force_rms_N", kind);
    for (const auto& [key, p] : cause.at("parameters").items()) {
        const bool one = p.at("value").is_number();
        f.key = key;
        f.value = one ? p["value"] : p["value"][0];
        f.low = one ? p.at("ci95")[0] : p.at("ci95")[0][0];
        f.high = one ? p.at("ci95")[1] : p.at("ci95")[0][1];
        if (!key.ends_with("phase_rad") && key.find("period") == key.npos) break; // how large, not where
    }
    return f;
}

} // namespace detail

/// From the diagnosis file, so that rows of this run and of earlier ones are the same.
inline row row_of(std::string name, const nlohmann::ordered_json& d) {
    try {
        row out;
        out.name = std::move(name);
        out.verdict = d.at("verdict");
        double largest = -1;
        for (const auto& [axis, a] : d.at("axes").items())
            if (const double gap = detail::number_of(a.at("gap"), "force_rms_N", detail::kind_of(a));
                gap > largest)
                largest = gap, out.axis = axis;
        if (d.contains("files") && d["files"].contains("machine"))
            out.machine = d["files"]["machine"]["sha256"];
        for (const auto& c : d.at("causes")) {
            const std::string effect = c.at("effect");
            const double alone = c.at("probability"), group = c.at("group_probability");
            const bool sure = std::max(alone, group) >= 0.5;
            if (out.cause.empty() || (sure && !out.claimed)) { // the first claim, else the first suspect
                std::vector<std::string> names{effect};
                if (sure && alone < 0.5) // the record does not say which
                    for (const std::string other : c.at("confusable_with")) names.push_back(other);
                out.cause = named(names, "or");
                out.axis = c.at("axis");
                out.claimed = sure;
                out.probability = sure ? std::max(alone, names.size() > 1 ? group : 0.0) : alone;
                out.shrink = c.at("shrink");
            }
            if (sure && std::find(out.claims.begin(), out.claims.end(), effect) == out.claims.end())
                out.claims.push_back(effect);
            if (sure) out.findings.push_back(detail::finding_of(c, d.at("axes").at(c.at("axis"))));
        }
        const auto& axis = d.at("axes").at(out.axis);
        const auto kind = detail::kind_of(axis);
        out.force_before_N = detail::number_of(axis.at("gap"), "force_rms_N", kind);
        out.force_after_N = detail::number_of(axis.at("gap_after"), "force_rms_N", kind);
        out.position_rms_m = detail::number_of(axis.at("gap"), "position_rms_m", kind);
        if (kind == quadrant::diagnosis::axis_kind::rotary) out.unit = "N m", out.length = "rad";
        return out;
    } catch (const nlohmann::json::exception& fault) {
        return failed_row(std::move(name), std::string("its diagnosis cannot be read: ") + fault.what());
    }
}

} // namespace quadrant_gap::fleet
