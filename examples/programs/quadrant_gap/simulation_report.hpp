// SPDX-License-Identifier: BSL-1.0
// Long: html_report() writes one page from top to bottom.
#pragma once
#include "report.hpp"
#include "simulation_summary.hpp"

#include <quadrant/diagnosis/log/log.hpp>

/// What a simulation leaves, as one HTML file that needs no network: the page of a diagnosis without causes.
namespace quadrant_gap {

inline std::string html_report(const simulation_result& s, const machine_log& log) {
    chart_book book(s.axes.size());
    std::string overviews, charts, notes, sentences;
    for (std::size_t k = 0; k < s.axes.size(); ++k) {
        const simulated_axis& a = s.axes[k];
        const axis_voice voice{a.kind, a.command_unit};
        sentences += (k == 0 ? "" : " ") + sentence(a);
        std::string rows;
        for (const auto& [name, value] : gap_rows(a))
            rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", capital(name), value);
        overviews +=
            fmt::format("<section data-axis-name=\"{0}\"><h2>Axis {0}</h2><table class=\"gap\"><caption>{1}"
                        "</caption><tbody>\n{2}</tbody></table></section>\n",
                        escape(a.name), escape(gap_basis(a)), rows);
        std::vector<double> error;
        for (const axis_log& logged : log.axes)
            if (logged.name == a.name && a.closed_loop)
                std::transform(a.position.begin(), a.position.end(), logged.position.begin(),
                               std::back_inserter(error), std::minus{});
        charts += fmt::format("<section><h2>Axis {}</h2>", escape(a.name));
        charts += book.figure(k, {"time",
                                  voice("Residual force"),
                                  voice("Force that the machine feels and the simulation does not."),
                                  "time",
                                  "s",
                                  voice("force"),
                                  voice("N"),
                                  a.t,
                                  {{"after", &a.force}},
                                  "there is none"});
        charts +=
            book.figure(k, {"time",
                            "Position error of the simulation",
                            "Closed loop, simulated minus logged.",
                            "time",
                            "s",
                            "position",
                            voice("m"),
                            a.t,
                            {{"after", &error}},
                            "the machine file has no controller for this axis, so its closed loop cannot be "
                            "simulated"});
        charts += "</section>\n";
    }
    for (const std::string& note : s.notes) notes += fmt::format("<li>{}</li>", escape(note));
    const std::string none = "<p class=\"empty\">None was sought: diagnose names them.</p>";
    std::string places;
    for (const simulated_axis& a : s.axes)
        for (const place& p : a.where)
            places += fmt::format("<dt>{}</dt><dd>axis {}: {}</dd>", escape(percent(p.share)), escape(a.name),
                                  escape(p.finding));
    return report_page(
        {{"title", escape(file_name(s.log_file) + " as " + file_name(s.machine_file) + " predicts it")},
         {"badge", ""},
         {"sentence", escape(sentences)},
         {"overview", overviews},
         {"causes", none},
         {"remaining", "<dl>" + places + "</dl>"},
         {"next", none},
         {"unseen", ""},
         {"axes", charts},
         {"notes", notes.empty() ? "<p class=\"empty\">None.</p>" : "<ul>" + notes + "</ul>"},
         {"files", fmt::format("<dl><dt>Machine</dt><dd>{}</dd><dt>Log</dt><dd>{}</dd></dl>",
                               escape(s.machine_file), escape(s.log_file))},
         {"charts", book.json_of_all()}});
}

} // namespace quadrant_gap
