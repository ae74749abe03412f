// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "chart.hpp"

#include "quadrant/diagnosis/log/signals.hpp"

/// One axis in pictures: its charts, and where the gap sits.
namespace quadrant_gap {

inline std::string share_row(std::string_view kind, std::string_view text, const estimate& share) {
    const auto width = [](double v) { return 100 * std::clamp(v, 0.0, 1.0); };
    const std::string whisker = share.high > share.low
                                    ? fmt::format("<b style=\"left:{:.1f}%;width:{:.1f}%\"></b>",
                                                  width(share.low), width(share.high) - width(share.low))
                                    : "";
    return fmt::format("<dt>{}</dt><dd class=\"{}\"><span class=\"bar\"><i "
                       "style=\"width:{:.1f}%\"></i>{}</span></dd><dd>{}</dd>\n",
                       text, kind, width(share.value), whisker, escape(percent(share)));
}

inline std::string shares(const axis_result& a) {
    std::string html;
    for (const auto& [view, title] : views) {
        std::string rows;
        double rest = 1;
        for (const place& p : a.where) {
            if (p.view != view) continue;
            rest -= p.share.value;
            const std::string basis = p.basis.empty() ? "" : fmt::format(" (by {})", p.basis);
            const std::string box = p.block.empty() ? "" : p.block + (p.finding.empty() ? "" : ": ");
            rows += share_row("found", escape(box + p.finding + basis), p.share);
        }
        if (rows.empty()) continue;
        if (rest > 0.005) rows += share_row("rest", "elsewhere", {.value = rest});
        html += fmt::format("<h4>{}</h4><dl class=\"shares\">{}</dl>\n", capital(std::string(title)), rows);
    }
    return html.empty() ? "<p class=\"empty\">There is no gap to place.</p>" : html;
}

inline std::string before_after(const axis_result& a, double before, double after, std::string_view unit) {
    if (a.signals.residual_after.empty()) return quantity(before, unit) + " rms";
    return fmt::format("{} rms before, {} after", quantity(before, unit), quantity(after, unit));
}

inline std::string axis_charts(chart_book& book, std::size_t index, const axis_result& a) {
    const axis_signals& s = a.signals;
    const axis_voice voice = voice_of(a);
    const bool of_positions = a.positions_only;
    const std::string length_unit = voice("m"), force_unit = of_positions ? length_unit : voice("N");
    const auto say = [&](const char* of_force, const char* of_two) {
        return of_positions ? std::string(of_two) : voice(of_force);
    };
    const auto error = [&](const std::vector<double>& simulated) {
        std::vector<double> e;
        if (simulated.size() == s.position.size())
            std::transform(simulated.begin(), simulated.end(), s.position.begin(), std::back_inserter(e),
                           std::minus{});
        return e;
    };
    const std::vector<double> error_before = error(s.simulated_position_before),
                              error_after = error(s.simulated_position_after);
    const std::vector<series> residual{{"before", &s.residual_before}, {"after", &s.residual_after}};
    const std::string no_residual = voice("the diagnosis holds no residual force for this axis");
    const std::string no_loop =
        "the machine file has no controller for this axis, so its closed loop cannot be simulated";

    const std::string force = book.figure(
        index,
        {"time", say("Residual force", "Difference of the two positions"),
         say("Force that the machine feels and the simulation does not: ",
             "What is read behind, less what was asked or counted: ") +
             (of_positions ? before_after(a, a.gap.position_rms_m, a.gap_after.position_rms_m, length_unit)
                           : before_after(a, a.gap.force_rms_N, a.gap_after.force_rms_N, force_unit)) +
             ".",
         "time", "s", say("force", "difference"), force_unit, s.t, residual, no_residual});
    const std::string position =
        of_positions
            ? ""
            : book.figure(index,
                          {"time",
                           "Position error of the simulation",
                           "Closed loop, simulated minus logged: " +
                               before_after(a, a.gap.position_rms_m, a.gap_after.position_rms_m, length_unit) +
                               ".",
                           "time",
                           "s",
                           "position",
                           length_unit,
                           s.t,
                           {{"before", &error_before}, {"after", &error_after}},
                           no_loop});
    const std::string command =
        of_positions
            ? ""
            : book.figure(
                  index,
                  {"time",
                   "Command",
                   s.command_replayed.empty()
                       ? "Controller output in the log; no controller is described that could be replayed."
                       : "Controller output in the log, and the described controller replayed on the logged "
                         "reference and position.",
                   "time",
                   "s",
                   "command",
                   voice.in_command_unit("V"),
                   s.t,
                   {{"logged", &s.command}, {"replayed", &s.command_replayed}},
                   "the diagnosis holds no command for this axis"});
    std::vector<double> beyond; // what the log commands beyond the replay
    if (!s.command_added.empty() && s.command_replayed.size() == s.command.size()) {
        std::vector<double> rest(s.command.size());
        for (std::size_t k = 0; k < rest.size(); ++k)
            rest[k] = s.command[k] - s.command_replayed[k] - s.command_added[k];
        const double constant =
            quadrant::diagnosis::quantile(std::move(rest), 0.5); // of the first integral, which no log holds
        for (std::size_t k = 0; k < s.command.size(); ++k)
            beyond.push_back(s.command[k] - s.command_replayed[k] - constant);
    }
    const std::string added =
        beyond.empty()
            ? ""
            : book.figure(index,
                          {"time",
                           "Added command",
                           "What the log commands beyond the replayed controller, and the waveform that was "
                           "recognised in it.",
                           "time",
                           "s",
                           "command",
                           voice.in_command_unit("V"),
                           s.t,
                           {{"logged minus replayed", &beyond}, {"waveform", &s.command_added}},
                           ""});
    const std::string velocity = book.figure(
        index, {"scatter", say("Residual force against velocity", "Difference against velocity"),
                say("Samples as dots, medians as lines: a step at zero is friction.",
                    "Samples as dots, medians as lines: a step at zero is lost motion, a slope is a lag."),
                "velocity", voice("m/s"), say("force", "difference"), force_unit, s.velocity, residual,
                no_residual, nullptr, &s.t});
    const std::string place = book.figure(
        index,
        {"scatter", say("Residual force against position", "Difference against position"),
         say("Samples as dots, medians of each direction as lines: a wave is cogging, a slope is a spring.",
             "Samples as dots, medians of each direction as lines: two lines are lost motion, a slope is a "
             "wrong "
             "lead, a wave is a pitch error."),
         "position", length_unit, say("force", "difference"), force_unit, s.position, residual, no_residual,
         &s.velocity, &s.t});
    const std::string spectrum =
        of_positions ? ""
                     : book.figure(index, {"spectrum",
                                           voice("Spectrum of the residual force"),
                                           voice("Peaks are resonances or forces periodic in time."),
                                           "frequency",
                                           "Hz",
                                           voice("force"),
                                           voice("N/√Hz"),
                                           s.frequency_Hz,
                                           {{"before", &s.spectrum_before}, {"after", &s.spectrum_after}},
                                           "the record is too short for a spectrum"});
    return fmt::format(
        "<section><h2>Axis {0}: the gap in pictures</h2>\n"
        "<div class=\"zoom\"><p class=\"hint\">Drag across a chart to zoom (two fingers on a touch screen); "
        "the charts in "
        "time move together, and those over velocity and position show the samples of that time. What each "
        "cause looks like: docs/gallery.md of Quadrant, and the gallery of its page.</p><button "
        "type=\"button\" data-axis=\"{1}\">Whole record</button></div>\n"
        "{2}{3}{4}<div class=\"still\">{5}{6}{7}</div>\n<h3>Where the gap sits</h3>\n{8}</section>\n",
        escape(a.name), index, force, position, command + added, velocity, place, spectrum, shares(a));
}

} // namespace quadrant_gap
