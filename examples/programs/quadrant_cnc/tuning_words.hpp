// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "tuning.hpp"
#include "words.hpp"

/// A tuning in words and in JSON.
namespace quadrant_cnc {

/// What the states of an attribute are called.
inline constexpr std::array<const char*, 5> oscillation_words{"far too much", "too much", "acceptable", "low",
                                                              "very low"},
    margin_words{"far too small", "too small", "acceptable", "more than needed", "far more than needed"},
    error_words{"extremely large", "large", "medium", "small", "OK"};

/// One trial, as the summary and the page say it.
struct trial_words {
    std::string gain, adaptation, oscillation, phase_margin, error;
};
inline trial_words words_of(const quadrant::analysis::tuning_step<>& s) {
    const auto state = [&](std::size_t attribute) { return std::size_t(s.states[attribute]); };
    return {.gain = number(s.gain.value()),
            .adaptation = number(s.adaptation.value()),
            .oscillation = fmt::format("{} ({})", number(s.trial.oscillation), oscillation_words[state(0)]),
            .phase_margin =
                std::isnan(s.trial.phase_margin)
                    ? "not stable"
                    : fmt::format("{} deg ({})", number(s.trial.phase_margin), margin_words[state(1)]),
            .error =
                fmt::format("{} µm ({})", number(1e6 * s.trial.tracking_error.value()), error_words[state(2)])};
}
inline std::string sentence(const axis_tuning& t) {
    const auto& from = t.start();
    const auto& to = t.end();
    if (!t.trials.settled)
        return fmt::format("Axis {}: the rules still ask for a change after {} trials; nothing is proposed.",
                           t.name, t.trials.steps.size());
    if (t.trials.steps.size() == 1) return fmt::format("Axis {}: the gains stay as they are.", t.name);
    return fmt::format(
        "Axis {}: gain {} to {} V s/m, adaptation {} to {} V/m; largest tracking error {} to {} µm.", t.name,
        number(from.gain.value()), number(to.gain.value()), number(from.adaptation.value()),
        number(to.adaptation.value()), number(1e6 * from.trial.tracking_error.value()),
        number(1e6 * to.trial.tracking_error.value()));
}
inline std::string summary(const std::vector<axis_tuning>& all) {
    std::string out;
    for (const axis_tuning& t : all) {
        out += sentence(t) + "\n";
        const auto line = [&](std::size_t k) {
            const trial_words w = words_of(t.trials.steps[k]);
            out +=
                fmt::format("  trial {:<3} gain {} V s/m, adaptation {} V/m: oscillation {}, phase margin {}, "
                            "tracking error {}\n",
                            k + 1, w.gain, w.adaptation, w.oscillation, w.phase_margin, w.error);
        };
        for (std::size_t k = 0; k < t.trials.steps.size(); ++k) line(k);
    }
    return out;
}
inline nlohmann::ordered_json to_json(const std::vector<axis_tuning>& all, const std::string& file,
                                      double period) {
    using json = nlohmann::ordered_json;
    json axes = json::object();
    for (const axis_tuning& t : all) {
        json trials = json::array();
        for (const auto& s : t.trials.steps) {
            json one = {{"gain_V_s_per_m", s.gain.value()},
                        {"adaptation_V_per_m", s.adaptation.value()},
                        {"oscillation", s.trial.oscillation}};
            if (std::isfinite(s.trial.phase_margin)) one["phase_margin_deg"] = s.trial.phase_margin;
            one["tracking_error_m"] = s.trial.tracking_error.value();
            trials.push_back(one);
        }
        axes[t.name] = {{"settled", t.trials.settled}, {"trials", trials}};
    }
    return {{"schema", "quadrant.cnc_tuning/1"}, {"cnc", file}, {"servo_period_s", period}, {"axes", axes}};
}

} // namespace quadrant_cnc
