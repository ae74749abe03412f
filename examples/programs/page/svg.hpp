// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "html.hpp"
#include "picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <numbers>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

/// Pictures as SVG inside the page, drawn by gnuplot as a program of its own. Text, frame, grid and lines take
/// their colours from the page's variables, so that dark and light both work.
namespace quadrant_page {

inline constexpr std::string_view gnuplot_package = "gnuplot-nox";
inline bool gnuplot_is_here() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

/// The samples to draw: the first, the last, the smallest and the largest of every bucket, so that no peak is
/// lost.
inline std::vector<std::size_t> peaks(const std::vector<double>& y, std::size_t limit = 1200) {
    std::vector<std::size_t> keep;
    const std::size_t n = y.size(), buckets = n > limit ? limit / 2 : n;
    for (std::size_t b = 0; b < buckets; ++b) {
        const auto at = [&](std::size_t k) { return y.begin() + static_cast<std::ptrdiff_t>(k); };
        const auto [low, high] = std::minmax_element(at(n * b / buckets), at(n * (b + 1) / buckets));
        const auto first = static_cast<std::size_t>(std::min(low, high) - y.begin());
        const auto second = static_cast<std::size_t>(std::max(low, high) - y.begin());
        keep.push_back(first);
        if (second != first) keep.push_back(second);
    }
    return keep;
}

/// "[um]", "[um/V]" and "um" as engineers write them.
inline std::string with_micro(std::string label) {
    if (label == "um") return "µm";
    for (const char* unit : {"um]", "um/"})
        if (const std::size_t at = label.find(unit); at != std::string::npos) label.replace(at, 2, "µm");
    return label;
}

/// A path in the shell's quotes.
inline std::string in_shell_quotes(std::string path) {
    replace_all(path, "'", "'\\''");
    return "'" + path + "'";
}

/// A text in gnuplot's quotes.
inline std::string in_quotes(std::string_view text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("\'\'") : std::string(1, c == '\n' ? ' ' : c);
    return out + "'";
}

/// gnuplot's text for one panel; the numbers of its lines go into named blocks in front.
class panel_script {
public:
    panel_script(const panel& p, std::size_t number) : p_(p), number_(number) {}

    std::string data() const {
        std::string text;
        for (std::size_t k = 0; k < p_.lines.size(); ++k) {
            const line& l = p_.lines[k];
            text += block(k) + " << EOD\n";
            for (const std::size_t i : peaks(l.y)) {
                const double radius = p_.polar_zero + l.y[i], angle = l.x[i] * std::numbers::pi / 180;
                const double x = p_.polar ? radius * std::cos(angle) : l.x[i],
                             y = p_.polar ? radius * std::sin(angle) : l.y[i];
                text += std::isfinite(x) && std::isfinite(y) ? fmt::format("{:.7g} {:.7g}\n", x, y) : "\n";
            }
            text += "EOD\n";
        }
        return p_.polar ? text + ring_data() : text;
    }
    /// Where it stands on the paper, from below, and whether its curves are named: a panel under another with
    /// the same curves need not say so again.
    struct place {
        double from = 0, height = 1;
        bool names = true;
    };
    std::string plot(const place& at) const {
        std::string text =
            "reset\nset grid lc rgb 'gray' dt solid lw 0.5\nset border lw 0.7\nset tics nomirror scale 0.5\n";
        text += fmt::format("set origin 0,{:.6g}\nset size 1,{:.6g}\n", at.from, at.height);
        text += at.names && p_.lines.size() > 1 ? "set key above maxrows 2 samplen 2\n" : "unset key\n";
        text += fmt::format("set xlabel {}\nset ylabel {}\n", in_quotes(with_micro(p_.x_label)),
                            in_quotes(with_micro(p_.y_label)));
        if (p_.log_x) text += "set logscale x\n";
        if (p_.log_y) text += "set logscale y\nset format y '%g'\n";
        if (p_.x_range) text += fmt::format("set xrange [{}:{}]\n", p_.x_range->first, p_.x_range->second);
        if (p_.y_range) text += fmt::format("set yrange [{}:{}]\n", p_.y_range->first, p_.y_range->second);
        if (p_.y_label.ends_with("[deg]")) text += "set ytics 90\n";
        if (p_.square || p_.polar) text += fmt::format("set size ratio -1 1,{:.6g}\n", at.height);
        if (p_.polar) text += round_frame();
        text += "plot ";
        for (std::size_t k = 0; p_.polar && k < ring_factors.size(); ++k)
            text += fmt::format("{} with lines lc rgb 'gray' lw 0.8 notitle, ", ring(k));
        for (std::size_t k = 0; k < p_.lines.size(); ++k) {
            const line& l = p_.lines[k];
            const double width = l.x.size() > 600 ? 1.2 : 1.6;
            const std::string drawn = l.drawn == line::style::points   ? "points pt 1 ps 1.2 lw 2"
                                      : l.drawn == line::style::dashed ? "lines lw 1.2 dt 2"
                                                                       : fmt::format("lines lw {}", width);
            text += fmt::format("{}{} with {} lc rgb '#0100{:02x}' title {}", k == 0 ? "" : ", ", block(k),
                                drawn, k + 1, in_quotes(l.name));
        }
        return text + "\n";
    }

private:
    std::string block(std::size_t k) const { return fmt::format("$panel{}line{}", number_, k); }
    static constexpr std::array ring_factors{0.5, 1.0, 1.5};
    std::string ring(std::size_t k) const { return fmt::format("$panel{}ring{}", number_, k); }
    /// The nominal circle, and one half as far either way.
    std::string ring_data() const {
        std::string text;
        for (std::size_t k = 0; k < ring_factors.size(); ++k) {
            text += ring(k) + " << EOD\n";
            for (int degrees = 0; degrees <= 360; degrees += 3) {
                const double angle = degrees * std::numbers::pi / 180, r = p_.polar_zero * ring_factors[k];
                text += fmt::format("{:.6g} {:.6g}\n", r * std::cos(angle), r * std::sin(angle));
            }
            text += "EOD\n";
        }
        return text;
    }
    std::string round_frame() const {
        const double r = p_.polar_zero, seen = 1.85 * r;
        std::string text = fmt::format("unset border\nunset tics\nunset grid\nunset ylabel\n"
                                       "set xrange [{0}:{1}]\nset yrange [{0}:{1}]\n",
                                       -seen, seen);
        for (const double factor : {0.5, 1.5})
            text += fmt::format("set label {} at {},{} font 'sans,11'\n",
                                in_quotes(fmt::format("{:+g} {}", r * (factor - 1), with_micro(p_.y_label))),
                                r * factor * 0.72, r * factor * 0.74);
        text += fmt::format("set arrow from {0},0 to {1},0 nohead lc rgb 'gray' lw 0.6\n"
                            "set arrow from 0,{0} to 0,{1} nohead lc rgb 'gray' lw 0.6\n",
                            -1.6 * r, 1.6 * r);
        for (const auto& [name, x, y] : {std::tuple{"0°", 1.72, 0.0}, std::tuple{"90°", 0.0, 1.75},
                                         std::tuple{"180°", -1.74, 0.0}, std::tuple{"270°", 0.0, -1.75}})
            text += fmt::format("set label '{}' at {},{} center\n", name, x * r, y * r);
        return text;
    }

    const panel& p_;
    std::size_t number_;
};

namespace detail {
/// What follows the XML prolog, in the page's colours, its identifiers its own among all pictures of the page.
inline std::string fit_into_page(std::string svg, std::size_t number, std::string_view label) {
    const std::size_t open = svg.find("<svg"), view = svg.find("viewBox", open),
                      canvas = svg.find("<g id=", open);
    if (canvas == std::string::npos || view == std::string::npos ||
        svg.find("</svg>", canvas) == std::string::npos)
        return ""; // lost on its way from gnuplot
    const std::string frame = svg.substr(view, svg.find('\n', view) - view);
    svg = fmt::format("<svg {} role=\"img\" aria-label=\"{}\">\n", frame, label) + svg.substr(canvas);
    for (const auto& [begin, end] :
         {std::pair<std::string_view, std::string_view>{"<filter", "</filter>"}, {"<title>", "</title>"}})
        for (std::size_t at; (at = svg.find(begin)) != std::string::npos;) {
            const std::size_t last = svg.find(end, at);
            if (last == std::string::npos) return "";
            svg.erase(at, last + end.size() - at);
        }
    for (const char* quote : {"\"", "'"}) {
        replace_all(svg, fmt::format("{0}black{0}", quote), fmt::format("{0}var(--ink){0}", quote));
        replace_all(svg, fmt::format("{0}gray{0}", quote), fmt::format("{0}var(--grid){0}", quote));
    }
    replace_all(svg, "rgb(190, 190, 190)", "var(--grid)");
    for (std::size_t k = 1; k <= 8; ++k)
        replace_all(svg, fmt::format("rgb(  1,   0, {:3})", k), fmt::format("var(--line-{})", k));
    replace_all(svg, "gpPt", fmt::format("p{}t", number));
    replace_all(svg, "gpDot", fmt::format("p{}dot", number));
    replace_all(svg, "gnuplot_canvas", fmt::format("p{}canvas", number));
    return svg;
}
} // namespace detail

/// One picture as SVG; empty when gnuplot did not draw it. `label` is HTML already.
inline std::string svg(const picture& drawn, std::size_t number, std::string_view label) {
    const std::size_t panels = drawn.panels.size();
    const auto height = [&](const panel& p) { return p.square || p.polar ? 440 : panels == 1 ? 300 : 220; };
    const auto names = [](const panel& p) {
        std::vector<std::string> all;
        for (const line& l : p.lines) all.push_back(l.name);
        return all;
    };
    int whole = 0;
    for (const panel& p : drawn.panels) whole += height(p);
    std::string script = fmt::format(
        "set encoding utf8\nset terminal svg size 480,{} dynamic noenhanced font 'sans,13' name 'p{}_'\n",
        whole, number);
    for (std::size_t k = 0; k < panels; ++k) script += panel_script(drawn.panels[k], k).data();
    if (panels > 1) script += "set multiplot\n";
    int below = whole;
    for (std::size_t k = 0; k < panels; ++k) {
        const panel& p = drawn.panels[k];
        below -= height(p);
        script += panel_script(p, k).plot({double(below) / whole, double(height(p)) / whole,
                                           k == 0 || names(p) != names(drawn.panels[k - 1])});
    }

    const int handle = memfd_create("quadrant", 0); // a file without a name leaves nothing behind
    if (handle < 0) return "";
    const std::string path = fmt::format("/proc/{}/fd/{}", getpid(), handle);
    std::string out;
    if (FILE* const file = fdopen(handle, "w")) {
        if (std::fputs(script.c_str(), file) >= 0 && std::fflush(file) == 0) {
            if (FILE* const pipe = popen(("gnuplot " + in_shell_quotes(path) + " 2>&1").c_str(), "r")) {
                std::array<char, 65536> part;
                while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe))
                    out.append(part.data(), n);
                if (pclose(pipe) != 0) out.clear();
            }
        }
        std::fclose(file);
    }
    return detail::fit_into_page(std::move(out), number, label);
}

/// The picture, or why it is not there.
inline std::string svg_or_reason(const picture& drawn, std::size_t number, std::string_view label,
                                 bool can_draw) {
    if (!can_draw)
        return fmt::format("<p class=\"empty\">Not drawn: gnuplot is not installed (Debian package {}).</p>",
                           gnuplot_package);
    const std::string done = svg(drawn, number, label);
    return done.empty() ? "<p class=\"empty\">gnuplot could not draw this.</p>" : done;
}

} // namespace quadrant_page
