// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fuzzy_trial.hpp"
#include "../row.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

/// "vcnc.fuzzy.case1" in a legend: "case 1".
inline std::string fuzzy_case_words(const std::string& id) { return std::string("case ") + id.back(); }

/// Figs. 12 and 13: tracking error and spectrum of the command with the first and with the tuned gains.
inline std::vector<picture> fuzzy_before_and_after(const std::string& id,
                                                   const vcnc::fuzzy_trial::record& before,
                                                   const vcnc::fuzzy_trial::record& after) {
    using quadrant::analysis::complex;
    const auto spectrum = [](const std::string& name, const std::vector<double>& command) {
        std::size_t size = 2;
        while (size < command.size()) size *= 2;
        std::vector<complex> bins(size);
        double mean = 0;
        for (const double u : command) mean += u / double(command.size());
        for (std::size_t k = 0; k < command.size(); ++k) bins[k] = command[k] - mean;
        quadrant::analysis::fft(bins);
        line out{.name = name, .x = {}, .y = {}};
        for (std::size_t k = 1; k < size / 2; ++k) {
            out.x.push_back(double(k) / (double(size) * vcnc::period.value()));
            out.y.push_back(std::max(2 * std::abs(bins[k]) / double(command.size()), 1e-5));
        }
        return out;
    };
    const auto errors = [](const std::string& name, const std::vector<double>& error) {
        line out{.name = name, .x = {}, .y = {}};
        for (std::size_t k = 0; k < error.size(); ++k)
            out.x.push_back(double(k) * vcnc::period.value()), out.y.push_back(error[k]);
        return out;
    };
    const std::string name = fuzzy_case_words(id);
    return {
        {"Tracking before and after tuning",
         "Reference minus table over 100 mm forth and back; top the first gains, below the tuned ones.",
         {panel{.x_label = "", .y_label = "before [um]", .lines = {errors(name, before.error)}},
          panel{.x_label = "time [s]", .y_label = "after [um]", .lines = {errors(name, after.error)}}}},
        {"Spectrum of the command before and after tuning",
         "Amplitudes; the oscillation index compares what lies above 50 Hz with what lies below.",
         {panel{
              .x_label = "", .y_label = "before [V]", .lines = {spectrum(name, before.command)}, .log_y = true},
          panel{.x_label = "frequency [Hz]",
                .y_label = "after [V]",
                .lines = {spectrum(name, after.command)},
                .log_y = true}}}};
}

inline outcome vcnc_fuzzy_case(const char* id, const vcnc::fuzzy_start& from) {
    using namespace quadrant::literals;
    auto start = vcnc::sliding_mode_of(vcnc::x_axis);
    start.gain = from.gain * 1000_V / 1_mps;
    start.adaptation = from.adaptation * 1000_V / 1_m;
    const auto tuned = quadrant::analysis::tune<quadrant::signal::voltage>(start, vcnc::fuzzy_trial());
    const auto& end = tuned.steps.back();
    const char* const at_start =
        std::isnan(tuned.steps.front().trial.phase_margin)
            ? "mean of 3 seeds; the linear loop is unstable and swings between the limits "
              "of the command: the source prints \"Unstable\""
            : "mean of 3 seeds";
    const std::string settled = tuned.settled ? "no attribute asks for a change" : "did not settle";
    outcome out;
    out.rows = {
        {id, "ks", "V s/mm", end.gain.value() / 1000, {}, {}, {}, settled},
        {id, "rho", "V/mm", end.adaptation.value() / 1000, {}, {}, {}, settled},
        {id, "peak_error", "um", 1e6 * end.trial.tracking_error.value(), {}, {}, {}, "mean of 3 seeds"},
        {id,
         "peak_error_at_start",
         "um",
         1e6 * tuned.steps.front().trial.tracking_error.value(),
         {},
         {},
         {},
         at_start},
        {id, "iterations", "1", double(tuned.steps.size() - 1), {}, {}, {}, "changes of the gains"},
        {id, "phase_margin", "deg", end.trial.phase_margin, {}, {}, {}, "with half a period more delay"},
        {id, "oscillation", "1", end.trial.oscillation, {}, {}, {}, "50 Hz, Sc = 2000"}};
    line gain{.name = fuzzy_case_words(id), .x = {}, .y = {}}, adaptation = gain, error = gain;
    for (std::size_t i = 0; i < tuned.steps.size(); ++i) {
        const auto& s = tuned.steps[i];
        for (line* l : {&gain, &adaptation, &error}) l->x.push_back(double(i));
        gain.y.push_back(s.gain.value() / 1000);
        adaptation.y.push_back(s.adaptation.value() / 1000);
        error.y.push_back(1e6 * s.trial.tracking_error.value());
    }
    out.pictures = {
        {"Fuzzy tuning from three starts",
         "Gains and the largest tracking error, trial by trial; Table 9 has 0.363, 0.315 and 0.269 V s/mm, "
         "47.2, 39.1 and "
         "37.2 V/mm, 9, 11 and 12 um.",
         {panel{.x_label = "trial", .y_label = "Ks [V s/mm]", .lines = {gain}, .log_y = true},
          panel{.x_label = "trial", .y_label = "rho [V/mm]", .lines = {adaptation}, .log_y = true},
          panel{.x_label = "trial", .y_label = "peak error [um]", .lines = {error}, .log_y = true}}}};
    const auto law_of = [&](const auto& step) {
        auto law = start;
        law.gain = step.gain, law.adaptation = step.adaptation;
        return law;
    };
    const auto before = vcnc::fuzzy_trial::run(start, 1), after = vcnc::fuzzy_trial::run(law_of(end), 1);
    for (picture& p : fuzzy_before_and_after(id, before, after)) out.pictures.push_back(std::move(p));
    return out;
}

inline outcome vcnc_fuzzy_table() {
    const char* id = "vcnc.fuzzy.table";
    constexpr std::array attributes{"OSC", "PHM", "TRE"};
    constexpr std::array states{"HIUN", "LIUN", "ACCP", "LIOQ", "HIOQ"}, errors{"EL", "LA", "ME", "SM", "OK"};
    outcome out;
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t s = 0; s < 5; ++s) {
            const std::string name = fmt::format("{}_{}", attributes[a], a == 2 ? errors[s] : states[s]);
            const auto& action = quadrant::analysis::decision_table[a][s];
            out.rows.push_back({id, name + "_ks", "1", action.gain, {}, {}, {}, ""});
            out.rows.push_back({id, name + "_rho", "1", action.adaptation, {}, {}, {}, ""});
        }
    return out;
}

inline experiment vcnc_fuzzy() {
    std::vector<run_case> runs{{"vcnc.fuzzy.table", vcnc_fuzzy_table}};
    static constexpr std::array ids{"vcnc.fuzzy.case1", "vcnc.fuzzy.case2", "vcnc.fuzzy.case3"};
    for (std::size_t i = 0; i < ids.size(); ++i)
        runs.push_back({ids[i], [i] { return vcnc_fuzzy_case(ids[i], vcnc::fuzzy_starts[i]); }});
    return {
        "Fuzzy tuning of the sliding mode law", "[Yeung2006] section 3, Tables 2 to 7 and 9, Fig. 13",
        "100 mm forth and back at 200 mm/s on the x axis, lambda 200 /s; from gains that are noisy, sluggish "
        "and "
        "unstable, until no attribute asks for a change. Sets, memberships and limits are those of Tables 2 to "
        "4, "
        "the decision table is computed from the rules. Threshold and scale of the oscillation index are not "
        "printed: 50 Hz and 2000 are ours, and half a period more delay in the phase margin.",
        0.02, std::move(runs)};
}

} // namespace quadrant_reproduce
