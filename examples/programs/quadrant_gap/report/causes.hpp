// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../words.hpp"
#include "html.hpp"

/// The table of what was named.
namespace quadrant_gap {

inline std::string lines(const std::vector<std::string>& all) {
    std::string html;
    for (const std::string& line : all) html += (html.empty() ? "" : "<br>") + escape(line);
    return html;
}

/// The 95 % interval as a band on a track that begins at zero and reaches `to` at least; the value is the
/// stroke in it. The ends of the track are written below it in `unit`.
inline std::string interval_bar(const estimate& e, std::string_view unit, double to = 0) {
    const double low = std::min(0.0, e.low), high = std::max(to, e.high);
    if (!(e.high > e.low) || !std::isfinite(high - low)) return "";
    const double margin = 0.06 * (high - low), from = low < 0 ? low - margin : 0,
                 whole = (high <= 0    ? 0
                          : high <= to ? to
                                       : high + margin) -
                         from;
    const auto at = [&](double v) { return 100 * (v - from) / whole; };
    const scale shown = scale_of(unit, std::max(std::abs(low), std::abs(high)));
    const auto end = [&](double v) { return with_unit(number(v * shown.factor), shown.unit); };
    return fmt::format(
        "<span class=\"bar range\" aria-hidden=\"true\"><i class=\"ends\" "
        "style=\"left:{:.1f}%;width:{:.1f}%\"></i><i class=\"value\" style=\"left:{:.1f}%\"></i></span><small "
        "class=\"ends\" aria-hidden=\"true\"><span>{}</span><span>{}</span></small>",
        at(e.low), at(e.high) - at(e.low), at(e.value), escape(end(from)), escape(end(from + whole)));
}

/// Each value with its interval, in words and as a bar.
inline std::string values(const std::vector<parameter_estimate>& parameters, const axis_voice& voice) {
    std::string html;
    for (const parameter_estimate& p : parameters) {
        const std::vector<std::string> said = lines_of(p, voice);
        for (std::size_t k = 0; k < said.size(); ++k)
            html += fmt::format("<div>{}{}</div>", escape(said[k]),
                                p.key.ends_with("phase_rad")
                                    ? ""
                                    : interval_bar(p.values[k], voice.in_command_unit(label_of(p.key).second)));
    }
    return html;
}

inline std::string probability_bar(const cause& c) {
    const double group = std::max(c.probability, c.group_probability);
    return fmt::format("{}<span class=\"bar\"><i class=\"group\" style=\"width:{:.0f}%\"></i><i "
                       "style=\"width:{:.0f}%\"></i></span>{}",
                       probability(c.probability), 100 * group, 100 * c.probability,
                       c.confusable_with.empty()
                           ? ""
                           : fmt::format("<small>{} with its alternatives</small>", probability(group)));
}

inline std::string causes(const diagnosis_result& d) {
    if (d.causes.empty())
        return d.verdict <= verdict::within_tolerance
                   ? "<p class=\"empty\">None is needed.</p>"
                   : "<p class=\"empty\">None of the known effects fits.</p>";
    std::string rows;
    for (const cause& c : d.causes) {
        const axis_voice voice = voice_of(d, c.axis);
        std::vector<std::string> gap;
        if (c.gap_before_force_rms_N.value > 0 || !(c.gap_before_position_rms_m.value > 0))
            gap.push_back(voice("force ") +
                          change(c.gap_before_force_rms_N.value, c.gap_after_force_rms_N.value, voice("N")));
        if (c.gap_before_position_rms_m.value > 0)
            gap.push_back("position " + change(c.gap_before_position_rms_m.value,
                                               c.gap_after_position_rms_m.value, voice("m")));
        if (c.gap_before_command_rms_V.value > 0)
            gap.push_back("command " + change(c.gap_before_command_rms_V.value, c.gap_after_command_rms_V.value,
                                              voice.in_command_unit("V")));
        const effect* known = effect_named(c.effect);
        const std::string_view box = known ? known->box : "";
        rows += fmt::format(
            "<tr data-effect=\"{}\"><th scope=\"row\"><span class=\"cause\">{}</span><small>axis "
            "{}{}{}{}</small></th>"
            "<td data-label=\"Probability\">{}</td><td data-label=\"Values found (95 % interval)\">{}</td>"
            "<td data-label=\"Gap before → after, rms\">{}</td><td data-label=\"Gap shrinks "
            "by\">{}</td></tr>\n",
            escape(c.effect), escape(capital(voice(name_of_effect(c.effect)))), escape(c.axis),
            box.empty() ? "" : ", ", box, claimed(c) ? "" : "<br>a suspect, not a claim", probability_bar(c),
            (c.waveform ? fmt::format("<div>{}</div>", escape(capital(waveform_in_words(d, c)))) : "") +
                values(c.parameters, voice),
            lines(gap), escape(percent(c.shrink)) + interval_bar(c.shrink, "%", 1));
        std::string more;
        if (!c.confusable_with.empty())
            more += fmt::format("On this record it cannot be distinguished from {}.",
                                escape(voice(named(c.confusable_with, "or"))));
        for (const reading& r : c.readings)
            more += fmt::format("<br>{}: {}.",
                                r.effect == c.effect
                                    ? "This record is explained as well by"
                                    : fmt::format("As {}", escape(voice(name_of_effect(r.effect)))),
                                escape(listed(lines_of(r.parameters, voice))));
        if (!c.exciting_motion.empty())
            more += fmt::format("{}Shown by: {}.", more.empty() ? "" : "<br>", escape(c.exciting_motion));
        if (known)
            more += fmt::format("{}What to do: {}", more.empty() ? "" : "<br>", escape(voice(known->remedy)));
        if (!more.empty())
            rows += fmt::format("<tr class=\"more\"><td colspan=\"5\"><small>{}</small></td></tr>\n", more);
    }
    return "<table><thead><tr><th scope=\"col\">Effect</th><th scope=\"col\">Probability</th><th "
           "scope=\"col\">Values found "
           "(95 % interval)</th><th scope=\"col\">Gap before → after, rms</th><th scope=\"col\">Gap "
           "shrinks by</th></tr>"
           "</thead><tbody>\n" +
           rows + "</tbody></table>";
}

} // namespace quadrant_gap
