// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fuzzy_trial.hpp"
#include "../row.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

struct fuzzy_case {
    const char* id;
    double gain, adaptation;                                     ///< at the start [V s/mm], [V/mm]
    double published_gain, published_adaptation, published_peak; ///< Table 9 [V s/mm], [V/mm], [um]
};

inline outcome vcnc_fuzzy_case(const fuzzy_case& c) {
    using namespace quadrant::literals;
    auto start = vcnc::sliding_mode_of(vcnc::x_axis);
    start.gain = c.gain * 1000_V / 1_mps;
    start.adaptation = c.adaptation * 1000_V / 1_m;
    const auto tuned = quadrant::analysis::tune<quadrant::signal::voltage>(start, vcnc::fuzzy_trial());
    const auto& end = tuned.steps.back();
    const std::string in_range =
        "tuned to a range: 0.2 to 0.4 V s/mm, 33 to 46 V/mm; " +
        std::string(tuned.settled ? "no attribute asks for a change" : "did not settle");
    outcome out;
    out.rows = {
        {c.id, "ks", "V s/mm", end.gain.value() / 1000, c.published_gain, {}, {}, in_range},
        {c.id, "rho", "V/mm", end.adaptation.value() / 1000, c.published_adaptation, {}, {}, in_range},
        {c.id,
         "peak_error",
         "um",
         1e6 * end.trial.tracking_error.value(),
         c.published_peak,
         {},
         {},
         fmt::format("at the start {:.1f} um; mean of 3 seeds",
                     1e6 * tuned.steps.front().trial.tracking_error.value())},
        {c.id, "iterations", "1", double(tuned.steps.size() - 1), {}, {}, {}, "changes of the gains"},
        {c.id, "phase_margin", "deg", end.trial.phase_margin, {}, {}, {}, "with half a period more delay"},
        {c.id, "oscillation", "1", end.trial.oscillation, {}, {}, {}, "50 Hz, Sc = 2000"}};
    line gain{.name = c.id, .x = {}, .y = {}}, adaptation = gain, error = gain;
    for (std::size_t i = 0; i < tuned.steps.size(); ++i) {
        const auto& s = tuned.steps[i];
        for (line* l : {&gain, &adaptation, &error}) l->x.push_back(double(i));
        gain.y.push_back(s.gain.value() / 1000);
        adaptation.y.push_back(s.adaptation.value() / 1000);
        error.y.push_back(1e6 * s.trial.tracking_error.value());
    }
    out.pictures = {
        {"Fuzzy tuning from three starts",
         "Gains and the largest tracking error, trial by trial.",
         {panel{.x_label = "trial", .y_label = "Ks [V s/mm]", .lines = {gain}, .log_y = true},
          panel{.x_label = "trial", .y_label = "rho [V/mm]", .lines = {adaptation}, .log_y = true},
          panel{.x_label = "trial", .y_label = "peak error [um]", .lines = {error}, .log_y = true}}}};
    return out;
}

inline outcome vcnc_fuzzy_table() {
    const char* id = "vcnc.fuzzy.table";
    constexpr std::array attributes{"OSC", "PHM", "TRE"};
    constexpr std::array states{"HIUN", "LIUN", "ACCP", "LIOQ", "HIOQ"}, errors{"EL", "LA", "ME", "SM", "OK"};
    constexpr std::array given{-0.2545, -0.2456, 0.0, 0.1552, 0.2456}; // Table 7, OSC, Ks
    outcome out;
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t s = 0; s < 5; ++s) {
            const std::string name = fmt::format("{}_{}", attributes[a], a == 2 ? errors[s] : states[s]);
            const auto& action = quadrant::analysis::decision_table[a][s];
            out.rows.push_back({id,
                                name + "_ks",
                                "1",
                                action.gain,
                                a == 0 ? std::optional(given[s]) : std::nullopt,
                                {},
                                {},
                                ""});
            out.rows.push_back({id, name + "_rho", "1", action.adaptation, {}, {}, {}, ""});
        }
    return out;
}

inline experiment vcnc_fuzzy() {
    // Published: Table 9 [Yeung2006], and of Table 7 what shared/reference/virtual_cnc.md has.
    static constexpr std::array cases{fuzzy_case{"vcnc.fuzzy.case1", 1, 100, 0.363, 47.16, 9},
                                      fuzzy_case{"vcnc.fuzzy.case2", 0.01, 1, 0.315, 39.12, 11},
                                      fuzzy_case{"vcnc.fuzzy.case3", 10, 10000, 0.269, 37.16, 12}};
    std::vector<run_case> runs{{"vcnc.fuzzy.table", vcnc_fuzzy_table}};
    for (const fuzzy_case& c : cases) runs.push_back({c.id, [&c] { return vcnc_fuzzy_case(c); }});
    return {
        "Fuzzy tuning of the sliding mode law", "[Yeung2006] section 3, Tables 7 and 9",
        "100 mm forth and back at 200 mm/s on the x axis, lambda 200 /s; from gains that are noisy, sluggish "
        "and "
        "unstable. The decision table is computed from the rules. Where the sets of the attributes end is not "
        "printed; the limits are ours, chosen so that gains like the published ones are accepted, so the "
        "figures to "
        "compare are ranges, not digits.",
        0.02, std::move(runs)};
}

} // namespace quadrant_reproduce
