// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "html.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// A graph of a few lines as SVG, drawn here, so that its page needs no script and no other program. Colours
/// are those of the page's classes.
namespace quadrant_page {

/// One direction of a graph.
struct graph_axis {
    double low = 0, high = 1;
    std::string label{};      ///< with its unit
    bool logarithmic = false; ///< ends above 0
    double step = 0;          ///< between marks; 0: 1, 2 or 5 times a power of ten; a logarithm has its decades

    double place(double value) const {
        return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    }
    std::vector<double> marks() const {
        std::vector<double> out;
        if (logarithmic) {
            for (double decade = std::pow(10.0, std::ceil(std::log10(low) - 1e-9)); decade <= high * 1.000001;
                 decade *= 10)
                out.push_back(decade);
            return out;
        }
        double by = step;
        if (!(by > 0)) {
            const double rough = (high - low) / 5, unit = std::pow(10.0, std::floor(std::log10(rough)));
            by = rough > 5 * unit ? 10 * unit : rough > 2 * unit ? 5 * unit : rough > unit ? 2 * unit : unit;
        }
        for (double v = by * std::ceil(low / by - 1e-9); v <= high + 1e-9 * by; v += by)
            out.push_back(std::abs(v) < 1e-9 * by ? 0 : v);
        return out;
    }
};

class graph {
public:
    static constexpr double width = 560, left = 62, right = 12, top = 10, bottom = 44;

    graph(graph_axis across, graph_axis up, double height = 260)
        : x_(std::move(across)), y_(std::move(up)), height_(height) {
        for (const double v : x_.marks()) {
            body_ += fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1}V{2:.1f}\"/>\n", px(v), top,
                                 height_ - bottom);
            body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:g}</text>\n", px(v),
                                 height_ - bottom + 17, v);
        }
        for (const double v : y_.marks()) {
            body_ += fmt::format("<path class=\"grid\" d=\"M{} {:.1f}H{}\"/>\n", left, py(v), width - right);
            body_ +=
                fmt::format("<text class=\"y\" x=\"{}\" y=\"{:.1f}\">{:g}</text>\n", left - 6, py(v) + 4, v);
        }
    }
    /// A line through points; it leaves the graph where they do, and where one is not finite.
    void line(std::string_view style, const std::vector<double>& x, const std::vector<double>& y) {
        std::string points;
        const auto end = [&] {
            if (!points.empty())
                body_ += fmt::format("<polyline class=\"{}\" points=\"{}\"/>\n", style, points);
            points.clear();
        };
        for (std::size_t k = 0; k < x.size(); ++k)
            if (inside(x[k], y[k]))
                points += fmt::format("{:.1f},{:.1f} ", px(x[k]), py(y[k]));
            else
                end();
        end();
    }
    void dot(std::string_view style, double x, double y) {
        if (inside(x, y))
            body_ += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>\n", style, px(x),
                                 py(y));
    }
    /// What a line means, one entry behind the other above the graph.
    void legend(std::string_view style, std::string_view words) {
        legend_ += fmt::format(
            "<span class=\"key\"><svg class=\"graph\" viewBox=\"0 0 22 10\" aria-hidden=\"true\"><path "
            "class=\"{}\" d=\"M1 5H21\"/></svg> {}</span> ",
            style, escaped(words));
    }
    /// `says`: what the picture shows, for whoever cannot see it.
    std::string figure(std::string_view says, std::string_view caption) const {
        return fmt::format(
            "<figure class=\"contour\"><p class=\"keys\">{}</p><svg class=\"plane graph\" viewBox=\"0 0 {} "
            "{}\" role=\"img\" "
            "aria-label=\"{}\">\n{}<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n"
            "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n"
            "<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text></svg>"
            "<figcaption>{}</figcaption></figure>\n",
            legend_, width, height_, escaped(says), body_, left, top, width - left - right,
            height_ - top - bottom, (left + width - right) / 2, height_ - 8, escaped(x_.label),
            (top + height_ - bottom) / 2, escaped(y_.label), escaped(caption));
    }

private:
    bool inside(double x, double y) const {
        return std::isfinite(x) && std::isfinite(y) && x >= x_.low * (x_.logarithmic ? 0.999999 : 1) - 1e-12 &&
               x <= x_.high * (1 + 1e-9) + 1e-12 && y >= y_.low && y <= y_.high;
    }
    double px(double v) const { return left + (width - left - right) * x_.place(v); }
    double py(double v) const { return height_ - bottom - (height_ - top - bottom) * y_.place(v); }

    graph_axis x_, y_;
    double height_;
    std::string body_{}, legend_{};
};

} // namespace quadrant_page
