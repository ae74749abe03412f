// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "page/html.hpp"
#include "scale.hpp"

#include <array>

/// A picture as a file of its own: panels below each other, on white, so that it reads on a light and on a dark
/// page. The
/// same numbers give the same bytes, on any computer: no fonts are measured and no program is asked.
namespace block_pictures {

class svg_file {
public:
    explicit svg_file(const picture& p) {
        std::string drawn;
        for (std::size_t k = 0; k < p.panels.size(); ++k)
            drawn += panel_at(p, k, p.panels.size() == 1 ? 250 : p.panels.size() == 2 ? 165 : 120);
        text_ = fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" viewBox=\"0 0 {0} "
            "{1:.0f}\" role=\"img\" aria-label=\"{2}\" font-family=\"sans-serif\" font-size=\"12\" "
            "fill=\"#18212b\">\n<rect width=\"{0}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n{3}</svg>\n",
            width, y_ + 4, quadrant_page::escaped(p.title), drawn);
    }
    const std::string& text() const { return text_; }

private:
    static constexpr double width = 560, left = 66, right = 546;
    static constexpr std::array colours{"#c2570c", "#1769c9", "#1f7f63", "#7a2fb5",
                                        "#8a6d00", "#b02a50", "#55616e"};

    std::string panel_at(const picture& p, std::size_t k, double height) {
        const panel& now = p.panels[k];
        std::string out;
        if (k == 0 || names(now) != names(p.panels[k - 1])) out += legend(now);
        const double top = y_ + 8, bottom = top + (now.square ? right - left : height);
        const scale x(now, true, left, right), y(now, false, bottom, top);
        for (const tick& t : x.ticks()) {
            out += rule(t, t.at, top, t.at, bottom);
            if (!t.label.empty()) out += words(t.at, bottom + 16, "middle", t.label);
        }
        for (const tick& t : y.ticks()) {
            out += rule(t, left, t.at, right, t.at);
            if (!t.label.empty()) out += words(left - 6, t.at + 4, "end", t.label);
        }
        out += fmt::format(
            "<clipPath id=\"c{}\"><rect x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\"/></clipPath>\n"
            "<g clip-path=\"url(#c{})\">\n",
            k, left, top - 1, right - left, bottom - top + 2, k);
        for (std::size_t i = now.lines.size(); i-- > 0;)
            out += drawn(now.lines[i], colours[i % colours.size()], x, y);
        out += fmt::format("</g>\n<rect x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" fill=\"none\" "
                           "stroke=\"#55616e\"/>\n",
                           left, top, right - left, bottom - top);
        out += fmt::format(
            "<text transform=\"translate(16,{:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            (top + bottom) / 2, quadrant_page::escaped(now.y_label));
        if (!now.x_label.empty()) out += words((left + right) / 2, bottom + 33, "middle", now.x_label);
        y_ = bottom + (now.x_label.empty() ? 22 : 40);
        return out;
    }
    static std::vector<std::string> names(const panel& p) {
        std::vector<std::string> all;
        for (const line& l : p.lines) all.push_back(l.name);
        return all;
    }
    /// In rows above the frame; a curve without a name has no place in it.
    std::string legend(const panel& p) {
        std::string out;
        double x = left;
        bool any = false;
        for (std::size_t i = 0; i < p.lines.size(); ++i) {
            if (p.lines[i].name.empty()) continue;
            const double needed = 42 + 6.5 * double(p.lines[i].name.size());
            if (!any) y_ += 18;
            if (any && x + needed > right + 10) x = left, y_ += 17;
            any = true;
            const double middle = y_ - 4;
            out += p.lines[i].drawn == line::style::points
                       ? dot(x + 10, middle, colours[i % colours.size()])
                       : fmt::format("<path d=\"M{:.1f},{:.1f}h20\" stroke=\"{}\" stroke-width=\"2\"{}/>\n", x,
                                     middle, colours[i % colours.size()], dashes(p.lines[i]));
            out += words(x + 25, y_, "start", p.lines[i].name);
            x += needed;
        }
        return out;
    }
    static const char* dashes(const line& l) {
        return l.drawn == line::style::dashed ? " stroke-dasharray=\"5,3\"" : "";
    }
    static std::string dot(double x, double y, const char* colour) {
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\" fill=\"{}\"/>\n", x, y, colour);
    }
    static std::string rule(const tick& t, double x1, double y1, double x2, double y2) {
        return fmt::format("<path d=\"M{:.1f},{:.1f}L{:.1f},{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2, y2,
                           t.label.empty() ? "#eef1f4" : "#d3d9e0");
    }
    static std::string words(double x, double y, const char* anchor, std::string_view text) {
        return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                           quadrant_page::escaped(text));
    }
    static std::string drawn(const line& l, const char* colour, const scale& x, const scale& y) {
        std::string out;
        std::vector<point> run;
        const auto end_run = [&] {
            const auto kept = simplified(run);
            if (kept.size() > 1) {
                std::string path;
                for (const point& p : kept)
                    path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "M" : " ", p.x, p.y);
                out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" "
                                   "stroke-linejoin=\"round\"{}/>\n",
                                   path, colour, dashes(l));
            }
            run.clear();
        };
        for (std::size_t i = 0; i < l.x.size(); ++i) {
            const point p{x(l.x[i]), y(l.y[i])};
            if (!std::isfinite(p.x) || !std::isfinite(p.y))
                end_run();
            else if (l.drawn == line::style::points)
                out += dot(p.x, p.y, colour);
            else
                run.push_back(p);
        }
        end_run();
        return out;
    }

    double y_ = 0; ///< where the next panel begins
    std::string text_;
};

} // namespace block_pictures
