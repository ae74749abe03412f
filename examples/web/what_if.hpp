// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant_gap/simulation_summary.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <nlohmann/json.hpp>

/// What the simulation would do with other values of the causes that were found: a slider for each.
namespace quadrant_web {
using namespace quadrant::diagnosis;

/// The sliders of one value: its interval, and how far it may be moved: from where the effect is absent to
/// twice the value; a phase goes round once.
inline nlohmann::json slider(const parameter_estimate& p, std::size_t index, const axis_kind kind,
                             const std::string& command_unit) {
    const quadrant_gap::axis_voice voice{kind, command_unit};
    const estimate& e = p.values[index];
    const auto [label, unit] = quadrant_gap::label_of(p.key);
    const auto shown = quadrant_gap::scale_of(voice.in_command_unit(unit), e.value);
    const bool phase = p.key.ends_with("phase_rad");
    const machine_key* key = key_named(p.key);
    const double neutral = key ? key->neutral : 0, low = std::min({neutral, e.low, 2 * e.value - neutral}),
                 high = std::max({neutral, e.high, 2 * e.value - neutral});
    return {{"key", p.key},
            {"label", label + (p.values.size() > 1 ? fmt::format(" {}", index + 1) : "")},
            {"unit", shown.unit},
            {"factor", shown.factor},
            {"value", e.value},
            {"low", phase ? -std::numbers::pi : low},
            {"high", phase ? std::numbers::pi : high},
            {"ci95", {e.low, e.high}}};
}

/// The causes of a diagnosis as the page shows them beside its sliders.
inline nlohmann::json knobs(const diagnosis_result& d) {
    nlohmann::json out = nlohmann::json::array();
    for (const cause& c : d.causes) {
        const axis_kind kind = d.kind_of(c.axis);
        nlohmann::json sliders = nlohmann::json::array();
        for (const parameter_estimate& p : c.parameters)
            for (std::size_t i = 0; i < p.values.size(); ++i)
                sliders.push_back(slider(p, i, kind, quadrant_gap::voice_of(d, c.axis).command_unit));
        out.push_back({{"axis", c.axis},
                       {"effect", c.effect},
                       {"label", quadrant_gap::capital(text_of(quadrant_gap::name_of_effect(c.effect), kind))},
                       {"probability", quadrant_gap::probability(std::max(c.probability, c.group_probability))},
                       {"claimed", quadrant_gap::claimed(c)},
                       {"sliders", sliders}});
    }
    return out;
}

/// The smallest and the largest of each of `buckets` parts of a signal: what a chart of as many pixels shows.
inline nlohmann::json envelope(const std::vector<double>& x, std::size_t buckets) {
    nlohmann::json low = nlohmann::json::array(), high = nlohmann::json::array();
    const std::size_t n = std::min(buckets, x.size());
    for (std::size_t b = 0; b < n; ++b) {
        const auto at = [&](std::size_t k) { return x.begin() + static_cast<std::ptrdiff_t>(k); };
        const auto [least, most] = std::minmax_element(at(x.size() * b / n), at(x.size() * (b + 1) / n));
        low.push_back(*least);
        high.push_back(*most);
    }
    return {low, high};
}

/// A simulation as the page draws it: residual force, and what the simulated loop does beside the logged one.
inline nlohmann::json drawn(const simulation_result& s, const machine_log& log) {
    constexpr std::size_t buckets = 700;
    nlohmann::json out = nlohmann::json::array();
    for (const simulated_axis& a : s.axes) {
        const axis_log* logged = detail::named(log.axes, a.name);
        const quadrant_gap::axis_voice voice{a.kind, a.command_unit};
        const auto beside = [&](const std::vector<double>& simulated, const std::vector<double>& measured) {
            std::vector<double> error(simulated.size());
            std::transform(simulated.begin(), simulated.end(), measured.begin(), error.begin(), std::minus{});
            return envelope(error, buckets);
        };
        nlohmann::json charts = {
            {{"title", voice("Residual force")}, {"unit", voice("N")}, {"lines", envelope(a.force, buckets)}}};
        if (a.closed_loop) {
            charts.push_back({{"title", "Position, simulated minus logged"},
                              {"unit", voice("m")},
                              {"lines", beside(a.position, logged->position)}});
            charts.push_back({{"title", "Command, simulated minus logged"},
                              {"unit", voice.in_command_unit("V")},
                              {"lines", beside(a.command, logged->command)}});
        }
        nlohmann::json gap = nlohmann::json::array();
        for (const auto& [name, value] : quadrant_gap::gap_rows(a)) gap.push_back({name, value});
        out.push_back({{"axis", a.name},
                       {"seconds", a.t.empty() ? 0 : a.t.back()},
                       {"force_rms", a.gap.force_rms_N},
                       {"gap", gap},
                       {"charts", charts}});
    }
    return out;
}

/// Whether values moved inside the tolerances that the machine file states.
inline bool has_calibration(const diagnosis_result& d) {
    return std::any_of(d.axes.begin(), d.axes.end(),
                       [](const axis_result& a) { return !a.calibrated.empty(); });
}

/// A diagnosis with the causes that are switched on, at the values of their sliders, whose intervals move
/// along: all of them are then written; and with the calibration inside the owner's tolerances, or without it.
inline diagnosis_result as_set(const diagnosis_result& found, const nlohmann::json& causes, bool calibrated) {
    diagnosis_result d = found;
    bool suspects = false;
    for (std::size_t k = 0; k < d.causes.size(); ++k) {
        cause& c = d.causes[k];
        const nlohmann::json& set = causes.at(k);
        const bool on = set.at("on").get<bool>();
        suspects = suspects || (on && !quadrant_gap::claimed(c));
        std::size_t next = 0;
        for (parameter_estimate& p : c.parameters)
            for (estimate& e : p.values) {
                const double moved = set.at("values").at(next++).get<double>() - e.value;
                e.value += moved;
                e.low += moved;
                e.high += moved;
            }
        c.with_suspects.clear();
        c.probability = c.group_probability = on ? 1 : 0;
    }
    for (axis_result& a : d.axes) {
        if (suspects && !a.calibrated_with_suspects.empty()) a.calibrated = a.calibrated_with_suspects;
        if (!calibrated) a.calibrated.clear();
    }
    return d;
}

} // namespace quadrant_web
