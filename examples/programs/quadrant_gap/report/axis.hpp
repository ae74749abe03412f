// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../gap_words.hpp"
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

/// The charts of one axis, each with its words. Between two positions there is a difference where other axes
/// have a force.
class axis_pictures {
public:
    axis_pictures(chart_book& book, std::size_t index, const axis_result& a)
        : book_(book), index_(index), a_(a), s_(a.signals), voice_(voice_of(a)),
          of_positions_(a.positions_only), length_unit_(voice_("m")),
          force_unit_(of_positions_ ? length_unit_ : voice_("N")), residual_{{"before", &s_.residual_before},
                                                                             {"after", &s_.residual_after}},
          no_residual_(voice_("the diagnosis holds no residual force for this axis")) {}

    std::string residual() const {
        const std::string sizes =
            of_positions_ ? before_after(a_, a_.gap.position_rms_m, a_.gap_after.position_rms_m, length_unit_)
                          : before_after(a_, a_.gap.force_rms_N, a_.gap_after.force_rms_N, force_unit_);
        return book_.figure(index_, {"time", say("Residual force", "Difference of the two positions"),
                                     say("Force that the machine feels and the simulation does not: ",
                                         "What is read behind, less what was asked or counted: ") +
                                         sizes + ".",
                                     "time", "s", say("force", "difference"), force_unit_, s_.t, residual_,
                                     no_residual_});
    }
    std::string position() const {
        if (of_positions_) return "";
        const std::vector<double> before = error(s_.simulated_position_before),
                                  after = error(s_.simulated_position_after);
        return book_.figure(
            index_,
            {"time",
             "Position error of the simulation",
             "Closed loop, simulated minus logged: " +
                 before_after(a_, a_.gap.position_rms_m, a_.gap_after.position_rms_m, length_unit_) + ".",
             "time",
             "s",
             "position",
             length_unit_,
             s_.t,
             {{"before", &before}, {"after", &after}},
             "the machine file has no controller for this axis, so its closed loop cannot be simulated"});
    }
    std::string command() const {
        if (of_positions_) return "";
        return book_.figure(
            index_, {"time",
                     "Command",
                     s_.command_replayed.empty()
                         ? "Controller output in the log; no controller is described that could be replayed."
                         : "Controller output in the log, and the described controller replayed on the logged "
                           "reference and position.",
                     "time",
                     "s",
                     "command",
                     voice_.in_command_unit("V"),
                     s_.t,
                     {{"logged", &s_.command}, {"replayed", &s_.command_replayed}},
                     "the diagnosis holds no command for this axis"});
    }
    std::string added_command() const {
        const std::vector<double> beyond = beyond_the_replay();
        if (beyond.empty()) return "";
        return book_.figure(index_, {"time",
                                     "Added command",
                                     "What the log commands beyond the replayed controller, and the waveform "
                                     "that was recognised in it.",
                                     "time",
                                     "s",
                                     "command",
                                     voice_.in_command_unit("V"),
                                     s_.t,
                                     {{"logged minus replayed", &beyond}, {"waveform", &s_.command_added}},
                                     ""});
    }
    std::string over_velocity() const {
        return book_.figure(
            index_, {"scatter", say("Residual force against velocity", "Difference against velocity"),
                     say("Samples as dots, medians as lines: a step at zero is friction.",
                         "Samples as dots, medians as lines: a step at zero is lost motion, a slope is a lag."),
                     "velocity", voice_("m/s"), say("force", "difference"), force_unit_, s_.velocity, residual_,
                     no_residual_, nullptr, &s_.t});
    }
    std::string over_position() const {
        return book_.figure(
            index_,
            {"scatter", say("Residual force against position", "Difference against position"),
             say("Samples as dots, medians of each direction as lines: a wave is cogging, a slope is a spring.",
                 "Samples as dots, medians of each direction as lines: two lines are lost motion, a slope is a "
                 "wrong "
                 "lead, a wave is a pitch error."),
             "position", length_unit_, say("force", "difference"), force_unit_, s_.position, residual_,
             no_residual_, &s_.velocity, &s_.t});
    }
    std::string spectrum() const {
        if (of_positions_) return "";
        return book_.figure(index_, {"spectrum",
                                     voice_("Spectrum of the residual force"),
                                     voice_("Peaks are resonances or forces periodic in time."),
                                     "frequency",
                                     "Hz",
                                     voice_("force"),
                                     voice_("N/√Hz"),
                                     s_.frequency_Hz,
                                     {{"before", &s_.spectrum_before}, {"after", &s_.spectrum_after}},
                                     "the record is too short for a spectrum"});
    }

private:
    std::string say(const char* of_force, const char* of_two) const {
        return of_positions_ ? std::string(of_two) : voice_(of_force);
    }
    std::vector<double> error(const std::vector<double>& simulated) const {
        std::vector<double> e;
        if (simulated.size() == s_.position.size())
            std::transform(simulated.begin(), simulated.end(), s_.position.begin(), std::back_inserter(e),
                           std::minus{});
        return e;
    }
    /// What the log commands beyond the replay, without the constant of the first integral, which no log holds.
    std::vector<double> beyond_the_replay() const {
        if (s_.command_added.empty() || s_.command_replayed.size() != s_.command.size()) return {};
        std::vector<double> rest(s_.command.size()), beyond;
        for (std::size_t k = 0; k < rest.size(); ++k)
            rest[k] = s_.command[k] - s_.command_replayed[k] - s_.command_added[k];
        const double constant = quadrant::diagnosis::quantile(std::move(rest), 0.5);
        for (std::size_t k = 0; k < s_.command.size(); ++k)
            beyond.push_back(s_.command[k] - s_.command_replayed[k] - constant);
        return beyond;
    }

    chart_book& book_;
    std::size_t index_;
    const axis_result& a_;
    const axis_signals& s_;
    axis_voice voice_;
    bool of_positions_;
    std::string length_unit_, force_unit_;
    std::vector<series> residual_;
    std::string no_residual_;
};

inline std::string axis_charts(chart_book& book, std::size_t index, const axis_result& a) {
    const axis_pictures draw(book, index, a);
    // Drawn one after the other: the page shows them in this order.
    const std::string force = draw.residual(), position = draw.position(), command = draw.command(),
                      added = draw.added_command(), velocity = draw.over_velocity(),
                      place = draw.over_position(), spectrum = draw.spectrum();
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
