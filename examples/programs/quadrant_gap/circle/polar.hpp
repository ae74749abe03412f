// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../page/svg.hpp"
#include "../report/html.hpp"
#include "words.hpp"

/// Circles with their deviation magnified, one picture for each feed and radius, both ways round in it.
namespace quadrant_gap::circle {

namespace detail {

/// What is drawn of a run: an instrument's deviation is about the fitted centre, for where it stood is no
/// error.
inline std::vector<double> drawn_deviation(const circle_run_result& k) {
    std::vector<double> out = k.run.deviation;
    if (k.run.source == circle_source::instrument)
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] -= k.centre_x * std::cos(k.run.angle[i]) + k.centre_y * std::sin(k.run.angle[i]);
    return out;
}

/// 1, 2 or 5 times a power of ten, at least v.
inline double round_up(double v) {
    const double ten = std::pow(10, std::floor(std::log10(v)));
    for (const double f : {1.0, 2.0, 5.0})
        if (f * ten >= v * (1 - 1e-9)) return f * ten;
    return 10 * ten;
}

inline std::string path_of(const circle_run_result& k, double zero, double per_metre) {
    const auto deviation = drawn_deviation(k);
    std::string d;
    for (const std::size_t i : quadrant_page::peaks(deviation, 2400)) {
        const double r = zero + per_metre * deviation[i], a = k.run.angle[i];
        d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", r * std::cos(a), -r * std::sin(a));
    }
    return fmt::format("<path class=\"run {}\" d=\"{}\"/>\n", k.run.counterclockwise ? "plus" : "minus", d);
}

inline std::string polar_plot(const std::vector<const circle_run_result*>& runs, double division) {
    constexpr double zero = 180, step = 50; // pixels: nominal circle, a division
    const circle_run& first = runs[0]->run;
    const double magnification = step / division / (zero / first.radius);
    const std::string title =
        fmt::format("{} mm at {} mm/s", number(1e3 * first.radius), number(1e3 * first.feed));
    const std::string label =
        fmt::format("Radial deviation of the circle of {}, magnified {:.0f} times", title, magnification);
    std::string svg =
        fmt::format("<svg viewBox=\"-300 -300 600 600\" role=\"img\" aria-label=\"{}\">\n", escape(label));
    for (const int ring : {-2, -1, 0, 1, 2})
        svg +=
            fmt::format("<circle class=\"ring{}\" r=\"{}\"/>", ring == 0 ? " nominal" : "", zero + ring * step);
    svg += "<path class=\"ring\" d=\"M-290 0H290M0 -290V290\"/>\n";
    for (const auto* k : runs) svg += path_of(*k, zero, step / division);
    for (const int ring : {-1, 1})
        svg += fmt::format("<text x=\"{0:.0f}\" y=\"{1:.0f}\">{2}</text>", 0.707 * (zero + ring * step),
                           -0.707 * (zero + ring * step), (ring > 0 ? "+" : "−") + micrometres(division));
    svg += "<text x=\"288\" y=\"-8\">x</text><text x=\"14\" y=\"-282\">y</text></svg>\n";
    return fmt::format(
        "<figure><h3>{}</h3><figcaption>A division is {}: magnified {:.0f} times.</figcaption>{}</figure>\n",
        escape(title), escape(micrometres(division)), magnification, svg);
}

} // namespace detail

inline std::string polar_plots(const circle_result& r) {
    double most = 1e-9;
    for (const circle_run_result& k : r.runs)
        for (const double d : detail::drawn_deviation(k)) most = std::max(most, std::abs(d));
    std::string out;
    std::vector<bool> done(r.runs.size());
    for (std::size_t j = 0; j < r.runs.size(); ++j) {
        if (done[j]) continue;
        std::vector<const circle_run_result*> same;
        for (std::size_t i = j; i < r.runs.size(); ++i)
            if (std::abs(r.runs[i].run.feed / r.runs[j].run.feed - 1) < 0.05 &&
                std::abs(r.runs[i].run.radius / r.runs[j].run.radius - 1) < 1e-3)
                same.push_back(&r.runs[i]), done[i] = true;
        out += detail::polar_plot(same, detail::round_up(most / 2.2));
    }
    return out;
}

} // namespace quadrant_gap::circle
