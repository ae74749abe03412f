// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../words.hpp"

#include <nlohmann/json.hpp>

namespace quadrant_gap::fleet {

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

/// From the diagnosis file, so that rows of this run and of earlier ones are the same.
inline row row_of(std::string name, const nlohmann::ordered_json& d) {
    try {
        row out;
        out.name = std::move(name);
        out.verdict = d.at("verdict");
        double largest = -1;
        for (const auto& [axis, a] : d.at("axes").items())
            if (const double gap = a.at("gap").at("force_rms_N"); gap > largest) largest = gap, out.axis = axis;
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
        }
        const auto& axis = d.at("axes").at(out.axis);
        out.force_before_N = axis.at("gap").at("force_rms_N");
        out.force_after_N = axis.at("gap_after").at("force_rms_N");
        out.position_rms_m = axis.at("gap").at("position_rms_m");
        return out;
    } catch (const nlohmann::json::exception& fault) {
        return failed_row(std::move(name), std::string("its diagnosis cannot be read: ") + fault.what());
    }
}

} // namespace quadrant_gap::fleet
