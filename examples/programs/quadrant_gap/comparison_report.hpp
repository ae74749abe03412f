// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "comparison_summary.hpp"
#include "report.hpp"

/// A comparison of two logs as one HTML file that needs no network: the page of a diagnosis whose simulation is
/// the other log's machine.
namespace quadrant_gap {

inline std::string differences_table(const comparison_result& c, const std::vector<difference>& all) {
    std::string rows;
    for (const difference& d : all) {
        const axis_voice voice = voice_of(c, d.axis);
        const auto cell = [&](const std::vector<parameter_estimate>& values_there) {
            return values_there.empty() ? std::string("not there") : values(values_there, voice);
        };
        rows += fmt::format(
            "<tr data-effect=\"{}\"><th scope=\"row\"><span class=\"cause\">{}</span><small>axis "
            "{}</small></th>"
            "<td data-label=\"Probability\">{}<span class=\"bar\"><i style=\"width:{:.0f}%\"></i></span></td>"
            "<td data-label=\"First log\">{}</td><td data-label=\"Second log\">{}</td>"
            "<td data-label=\"Gap before → after, rms\">{}</td></tr>\n",
            escape(d.effect), escape(capital(voice(claim(d)))), escape(d.axis), probability(d.probability),
            100 * d.probability, cell(d.first), cell(d.second), lines(gaps_of(d, voice)));
        if (const effect* known = effect_named(d.effect))
            rows += fmt::format("<tr class=\"more\"><td colspan=\"5\"><small>Shown by: {}.<br>What to do: {}"
                                "</small></td></tr>\n",
                                escape(voice(known->exciting_motion)), escape(voice(known->remedy)));
    }
    return "<table class=\"compared\"><thead><tr><th scope=\"col\">Effect</th><th "
           "scope=\"col\">Probability</th><th "
           "scope=\"col\">First log</th><th scope=\"col\">Second log</th><th scope=\"col\">Gap before → "
           "after, rms</th></tr></thead><tbody>\n" +
           rows + "</tbody></table>";
}

inline std::string html_report(const comparison_result& c) {
    chart_book book(c.across.axes.size());
    std::string overviews, charts, notes;
    for (const compared_axis& a : c.axes) {
        const std::string force = voice_of(a)("N"), other = a.found_in_second ? "second" : "first",
                          reference = a.found_in_second ? "first" : "second";
        std::string rows;
        const auto row = [&](const std::string& what, double value) {
            rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", what,
                                escape(quantity(value, force)));
        };
        if (a.force_before_N > 0) {
            row(fmt::format("{} log, by the model of the {}", capital(other), reference), a.force_before_N);
            row("with the differences that are named", a.force_after_N);
            row("by its own model", a.force_own_N);
            row(fmt::format("{} log, by its own model", capital(reference)), a.force_common_N);
            row("sensor noise and rounding alone", a.floor_N);
        }
        std::string inside;
        for (const std::string& line : calibrated_lines(a)) inside += paragraph(line);
        overviews += fmt::format(
            "<section data-axis-name=\"{0}\"><h2>Axis {0}</h2>{1}<table class=\"gap\"><caption>{2}</caption>"
            "<tbody>\n{3}</tbody></table>{4}</section>\n",
            escape(a.name), c.axes.size() > 1 ? paragraph(sentence(c, a)) : "",
            rows.empty() ? "Compared by name: the forces of this axis are not in the log."
                         : voice_of(a)("Residual force, rms"),
            rows, inside.empty() ? "" : "<h3>Inside the tolerances of the machine file</h3>" + inside);
    }
    for (std::size_t k = 0; k < c.across.axes.size(); ++k) charts += axis_charts(book, k, c.across.axes[k]);
    for (const std::string& note : c.notes) notes += fmt::format("<li>{}</li>", escape(note));
    std::string files;
    for (const auto& [name, file] :
         {std::pair{"Machine", c.machine_file}, {"First log", c.first_file}, {"Second log", c.second_file}})
        files += fmt::format("<dt>{}</dt><dd>{}</dd>", name, escape(file));
    return report_page(
        {{"kind", "Two logs of a servo axis, beside each other"},
         {"causes_title", "Differences"},
         {"remaining_title", "Each log alone"},
         {"next_title", "Not decided"},
         {"title", escape(file_name(c.first_file) + " beside " + file_name(c.second_file))},
         {"badge", fmt::format("<span class=\"badge {}\">{}</span>", name_of(c.likeness), name_of(c.likeness))},
         {"sentence", escape(sentence(c))},
         {"overview", overviews},
         {"causes", c.differences.empty() ? "<p class=\"empty\">No difference is named.</p>"
                                          : differences_table(c, c.differences)},
         {"remaining", paragraph("First log alone: " + verdict_sentence(c.first)) +
                           paragraph("Second log alone: " + verdict_sentence(c.second))},
         {"next", c.undecided.empty()
                      ? "<p class=\"empty\">Nothing is left undecided.</p>"
                      : "<p>Seen in one log, and not excluded by the other: record in both what "
                        "shows it.</p>" +
                            differences_table(c, c.undecided)},
         {"unseen", ""},
         {"axes", charts},
         {"notes", notes.empty() ? "<p class=\"empty\">None.</p>" : "<ul>" + notes + "</ul>"},
         {"files", "<dl>" + files + "</dl>"},
         {"charts", book.json_of_all()}});
}

} // namespace quadrant_gap
