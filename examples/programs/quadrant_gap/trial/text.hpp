// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>

/// The figures of a trial as text.
namespace quadrant_gap::trial {

using nlohmann::ordered_json;

/// "17 of 20 (85 %, 62 to 97 %)"
inline std::string share_text(const ordered_json& s) {
    if (s.at("of") == 0) return "none";
    return fmt::format("{} of {} ({:.0f} %; 95 % interval {:.0f} to {:.0f} %)", s.at("right").get<int>(),
                       s.at("of").get<int>(), 100 * s.at("share").get<double>(),
                       100 * s.at("ci95")[0].get<double>(), 100 * s.at("ci95")[1].get<double>());
}

inline std::string recalibration_text(const ordered_json& c) {
    const auto with_interval = [&](const char* key) {
        const auto& e = c.at(key);
        return fmt::format("{:.2f} ({:.2f} to {:.2f})", e["value"].get<double>(), e["ci95"][0].get<double>(),
                           e["ci95"][1].get<double>());
    };
    return fmt::format("slope {}, offset {} (calibrated: 1 and 0)", with_interval("slope"),
                       with_interval("offset"));
}

inline std::string summary_text(const ordered_json& t) {
    std::string out = "Right answers (verdict, first cause, nothing else blamed), as gap/check.py judges\n";
    for (const auto& [kind, s] : t.at("top1").items()) out += fmt::format("  {:22} {}\n", kind, share_text(s));
    out += fmt::format("Box                      {}\n", share_text(t.at("box")));
    const auto& f = t.at("false_blame");
    out += fmt::format("Blamed without an effect {} of {}; upper 95 % bound {:.1f} %\n",
                       f.at("blamed").get<int>(), f.at("of").get<int>(), 100 * f.at("upper95").get<double>());
    out += fmt::format("Without an answer        {}\n", t.at("unanswered").get<int>());
    out += fmt::format("Intervals that cover     {}\n", share_text(t.at("coverage")));
    out += fmt::format("Forecast within 10 pts   {}\n", share_text(t.at("forecast_within_10_points")));
    out += fmt::format("Brier, over {} causes    {:.3f}\n", t.at("calibration").at("causes").get<int>(),
                       t.at("calibration").at("brier").get<double>());
    out += "Recalibration            " + recalibration_text(t.at("calibration")) + "\n";
    if (t.at("calibration").contains("bins"))
        for (const auto& b : t["calibration"]["bins"])
            out += fmt::format("  said {:.2f}: right {:.2f} of {}\n", b["said"].get<double>(),
                               b["right"].get<double>(), b["of"].get<int>());
    out +=
        "Single effects by size (in 95th percentiles of the tolerance cloud): named, silent, another named\n";
    for (const auto& d : t.at("detection"))
        out += fmt::format("  from {:<4} {:3}: {:3} {:3} {:3}\n", d["from_clouds"].get<double>(),
                           d["of"].get<int>(), d["named"].get<int>(), d["silent"].get<int>(),
                           d["another"].get<int>());
    out += "Not right\n";
    for (const auto& c : t.at("cases"))
        if (!c["right"].get<bool>())
            out += fmt::format("  {:03} {} {} size {:.2f}: {}\n", c["index"].get<int>(),
                               c["kind"].get<std::string>(), c["truth"].get<std::string>(),
                               c["size"].is_number() ? c["size"].get<double>() : 0.0,
                               c["said"].get<std::string>());
    return out;
}

} // namespace quadrant_gap::trial
