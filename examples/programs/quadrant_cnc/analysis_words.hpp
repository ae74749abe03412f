// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "analysis_result.hpp"
#include "words.hpp"

/// An analysis in words and in JSON.
namespace quadrant_cnc {

/// Above it a loop is called nervous: the usual range of a good one is 1.2 to 2 [Astrom1995].
inline constexpr double largest_sensitivity = 2;

/// One figure of an axis, as the summary and the page say it.
struct figure_words {
    std::string name, value, says;
};
inline void say_proposal(std::vector<figure_words>& out, const proposal& p) {
    if (!p.gains) {
        out.push_back({"proposed gains", "none: " + p.no_gains, "of a cascade (cascade_p_pi)"});
        return;
    }
    const proposed_gains& g = *p.gains;
    out.push_back(
        {"proposed velocity gain",
         fmt::format("{} V s/m, integral {} V/m", number(g.velocity_gain), number(g.velocity_integral)),
         fmt::format("of a cascade (cascade_p_pi), {}; more is kept off by its {} at {} Hz",
                     p.velocity_filter_Hz > 0
                         ? fmt::format("velocity filter {} Hz", number(p.velocity_filter_Hz))
                         : p.estimator,
                     g.velocity_limit, number(g.velocity_limit_Hz))});
    out.push_back(
        {"proposed position gain", fmt::format("{} 1/s", number(g.position_gain)),
         fmt::format("more is kept off by its {} at {} Hz", g.position_limit, number(g.position_limit_Hz))});
    if (p.notch)
        out.push_back({"proposed notch",
                       fmt::format("at {} Hz, width {}", number(p.notch->frequency_Hz), number(p.notch->width)),
                       fmt::format("for a peak of {} dB; without it the velocity gain is {} V s/m",
                                   number(p.notch->prominence_dB), number(p.notch->without))});
    else
        out.push_back({"proposed notch", "none: " + p.no_notch, "for the highest peak above the crossover"});
}
inline std::vector<figure_words> figures_of(const axis_analysis& a) {
    std::vector<figure_words> out;
    if (!a.lines.empty()) {
        const auto& f = a.figures;
        const bool crosses = !a.told() || a.stable; // else a crossing is no margin
        out.push_back({"phase margin",
                       !crosses ? "none: the loop is not stable"
                       : f.phase
                           ? fmt::format("{} deg at {} Hz", number(f.phase->value), number(f.phase->at.value()))
                           : "none",
                       "how much later the loop may answer: 30 to 60 deg are usual"});
        std::string gain = f.gain_rise  ? fmt::format("{} dB", number(*f.gain_rise))
                           : a.measured ? "no limit in the measured band"
                                        : "without bound";
        if (f.gain_fall) gain += fmt::format("; it may fall by {} dB", number(*f.gain_fall));
        out.push_back({"gain margin", crosses ? gain : "none: the loop is not stable",
                       "how much the gain may rise until the loop is unstable: 6 dB are usual"});
        out.push_back(
            {"sensitivity, peak",
             fmt::format("{} at {} Hz", number(f.sensitivity_peak), number(f.margins.modulus.at.value())),
             "the most by which a disturbance is made larger: 1.2 to 2 is usual"});
        out.push_back({"disturbances fall below",
                       f.bandwidth ? fmt::format("{} Hz", number(f.bandwidth->value())) : "no frequency",
                       "where the sensitivity comes up through -3 dB"});
        out.push_back({"bandwidth of tracking",
                       a.bandwidth_Hz ? fmt::format("{} Hz", number(*a.bandwidth_Hz))
                       : a.measured   ? "not in the measured band"
                                      : "above what is known (0.4 of the sampling rate)",
                       "where the table over the reference falls through -3 dB"});
        out.push_back({"tracking, peak",
                       fmt::format("{} at {} Hz", number(a.tracking_peak), number(a.tracking_peak_Hz)),
                       "the most by which a motion is made larger"});
        out.push_back(
            {"dynamic stiffness, least",
             fmt::format("{} N/µm at {} Hz", number(1e-6 * a.stiffness_N_per_m), number(a.stiffness_Hz)),
             "the force that moves the table by a micrometre"});
    }
    if (a.measured) say_proposal(out, a.measured->proposed);
    const auto step = [&](const quadrant::analysis::step_figures& y) {
        const auto ms = [](const auto& t) { return number(1e3 * t->value()); };
        return fmt::format("{}, overshoots by {} %, {}",
                           y.rise ? fmt::format("rises in {} ms", ms(y.rise)) : "does not rise to 90 %",
                           number(100 * y.overshoot),
                           y.settling ? fmt::format("settled in {} ms", ms(y.settling))
                                      : "not settled in 10 s");
    };
    out.push_back(
        {fmt::format("step of {} µm{}", number(1e6 * a.step.size_m), a.measured ? ", machine file" : ""),
         step(a.step.as_it_is), "with friction, rounding and limits; from 10 to 90 %, and within 2 %"});
    if (a.step.differs())
        out.push_back(
            {"the same, linear part", step(a.step.linear), "without friction, play, rounding and limits"});
    if (a.step.limited > 0)
        out.push_back({"at a limit", fmt::format("{} periods", a.step.limited), "of the step"});
    return out;
}
inline std::string state_of(const axis_analysis& a) {
    return !a.told()   ? "whether it is stable the measured band does not tell (" + a.measured->not_told + ")"
           : !a.stable ? "not stable"
           : !a.linear ? "stable; its law is not linear, so it has no frequency response"
                       : "stable";
}
/// What all axes come to.
inline std::string sentence(const machine_analysis& m) {
    std::string unstable;
    const axis_analysis *slowest = nullptr, *worst = nullptr;
    for (const axis_analysis& a : m.axes) {
        if (a.told() && !a.stable) unstable += (unstable.empty() ? "" : " and ") + a.name;
        if (a.lines.empty()) continue;
        if (!worst || a.figures.sensitivity_peak > worst->figures.sensitivity_peak) worst = &a;
        if (a.bandwidth_Hz && (!slowest || *a.bandwidth_Hz < *slowest->bandwidth_Hz)) slowest = &a;
    }
    if (!unstable.empty()) return fmt::format("Axis {} is not stable.", unstable);
    const bool told = std::all_of(m.axes.begin(), m.axes.end(), [](const auto& a) { return a.told(); });
    std::string out = !told                ? "The band does not tell whether the axis is stable"
                      : m.axes.size() == 1 ? "The axis is stable"
                                           : "Every axis is stable";
    if (worst)
        out += fmt::format("; sensitivity {} at most (axis {})", number(worst->figures.sensitivity_peak),
                           worst->name);
    if (slowest)
        out += fmt::format("; tracking reaches {} Hz on the slowest (axis {})", number(*slowest->bandwidth_Hz),
                           slowest->name);
    return out + ".";
}
inline std::string summary(const machine_analysis& m) {
    std::string out =
        fmt::format("{}, servo period {} ms\n{}\n", m.cnc_file, number(1e3 * m.period), sentence(m));
    for (const axis_analysis& a : m.axes) {
        out += fmt::format("Axis {} ({}): {}\n", a.name, a.law, state_of(a));
        for (const figure_words& f : figures_of(a)) out += fmt::format("  {:<26} {}\n", f.name, f.value);
    }
    for (const std::string& note : m.notes) out += fmt::format("Note: {}\n", note);
    return out;
}

inline nlohmann::ordered_json to_json(const quadrant::analysis::step_figures& y) {
    nlohmann::ordered_json out = {{"overshoot", y.overshoot}, {"peak_m", y.peak.value()}};
    if (y.rise) out["rise_s"] = y.rise->value();
    if (y.settling) out["settling_s"] = y.settling->value();
    return out;
}
inline nlohmann::ordered_json to_json(const measured_axis& m) {
    using json = nlohmann::ordered_json;
    json out = {{"file", m.file}, {"lines", m.lines}, {"from_Hz", m.from_Hz}, {"to_Hz", m.to_Hz}};
    if (!m.not_told.empty()) out["stability_not_told"] = m.not_told;
    const proposal& p = m.proposed;
    json control = {{"law", "cascade_p_pi"}};
    if (p.gains) {
        control["position_gain_per_s"] = p.gains->position_gain;
        control["velocity_gain_V_s_per_m"] = p.gains->velocity_gain;
        control["velocity_integral_V_per_m"] = p.gains->velocity_integral;
        control["velocity_estimator"] = p.estimator;
        if (p.velocity_filter_Hz > 0) control["velocity_filter_Hz"] = p.velocity_filter_Hz;
        if (p.notch) control["notch"] = {{"frequency_Hz", p.notch->frequency_Hz}, {"width", p.notch->width}};
        out["proposed_control"] = control;
        out["proposed_for"] = {{"gain_margin_dB", p.wanted.gain_dB},
                               {"phase_margin_deg", p.wanted.phase_deg},
                               {"modulus_margin", p.wanted.modulus}};
        out["velocity_gain_limited_by"] = p.gains->velocity_limit;
        out["position_gain_limited_by"] = p.gains->position_limit;
    } else {
        out["no_gains"] = p.no_gains;
    }
    if (!p.no_notch.empty()) out["no_notch"] = p.no_notch;
    return out;
}
inline nlohmann::ordered_json to_json(const axis_analysis& a) {
    using json = nlohmann::ordered_json;
    json out = {{"law", a.law}};
    if (a.told()) out["stable"] = a.stable;
    out["linear"] = a.linear;
    if (a.measured) out["measured"] = to_json(*a.measured);
    if (!a.lines.empty()) {
        const auto& f = a.figures;
        const auto margins = [](const std::vector<quadrant::analysis::margin>& all, const char* key) {
            json list = json::array();
            for (const auto& m : all) list.push_back({{key, m.value}, {"frequency_Hz", m.at.value()}});
            return list;
        };
        out["phase_margins"] = margins(f.margins.phase_crossings, "deg");
        out["gain_margins"] = margins(f.margins.gain_crossings, "dB");
        if (f.gain_rise) out["gain_may_rise_dB"] = *f.gain_rise;
        if (f.gain_fall) out["gain_may_fall_dB"] = *f.gain_fall;
        out["sensitivity_peak"] = f.sensitivity_peak;
        out["sensitivity_peak_Hz"] = f.margins.modulus.at.value();
        if (f.bandwidth) out["sensitivity_bandwidth_Hz"] = f.bandwidth->value();
        if (a.bandwidth_Hz) out["tracking_bandwidth_Hz"] = *a.bandwidth_Hz;
        out["tracking_peak"] = a.tracking_peak;
        out["tracking_peak_Hz"] = a.tracking_peak_Hz;
        out["stiffness_least_N_per_m"] = a.stiffness_N_per_m;
        out["stiffness_least_Hz"] = a.stiffness_Hz;
        json lines = json::array();
        for (const response_line& l : a.lines) {
            json one = {l.frequency_Hz, l.open.real(), l.open.imag(), l.sensitivity.real(),
                        l.sensitivity.imag()};
            if (l.tracking != quadrant::analysis::complex())
                one.push_back(l.tracking.real()), one.push_back(l.tracking.imag());
            lines.push_back(one);
        }
        out["response"] = {{"columns",
                            {"frequency_Hz", "open_re", "open_im", "sensitivity_re", "sensitivity_im",
                             "tracking_re", "tracking_im"}},
                           {"rows", lines}};
    }
    out["step"] = {{"size_m", a.step.size_m},
                   {"as_it_is", to_json(a.step.as_it_is)},
                   {"linear", to_json(a.step.linear)},
                   {"limited_periods", a.step.limited}};
    return out;
}
inline nlohmann::ordered_json to_json(const machine_analysis& m) {
    nlohmann::ordered_json axes = nlohmann::ordered_json::object();
    for (const axis_analysis& a : m.axes) axes[a.name] = to_json(a);
    return {{"schema", "quadrant.cnc_analysis/1"},
            {"cnc", m.cnc_file},
            {"servo_period_s", m.period},
            {"axes", axes},
            {"notes", m.notes}};
}

} // namespace quadrant_cnc
