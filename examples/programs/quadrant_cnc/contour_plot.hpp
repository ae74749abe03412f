// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "run_result.hpp"
#include "words.hpp"

#include <array>
#include <functional>

/// The path and the table beside it, in the plane in which the path is largest, as SVG: drawn here, so that it
/// needs no script.
namespace quadrant_cnc {

/// 1, 2 or 5 times a power of ten, not below `value`.
inline double round_up(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)));
    for (const double m : {1.0, 2.0, 5.0})
        if (m * unit >= value * (1 - 1e-9)) return m * unit;
    return 10 * unit;
}
inline double round_down(double value) {
    const double up = round_up(value), tenth = std::pow(10.0, std::floor(std::log10(up) + 1e-9));
    if (up <= value * (1 + 1e-9)) return up;
    const double digit = std::round(up / tenth);
    return digit == 1 ? up / 2 : digit == 2 ? up / 2 : up / 2.5;
}

/// A window of the plane on paper; equal scales, y upwards.
class plane {
public:
    /// In metres, with the unit in which its numbers are written.
    plane(double x_low, double x_high, double y_low, double y_high, double unit, std::string_view unit_name,
          char across, char up)
        : unit_(unit), unit_name_(unit_name), across_(across), up_(up) {
        const double most = std::max({x_high - x_low, y_high - y_low, 1e-9}), margin = 0.06 * most;
        // No window is flatter than two to one.
        const double wide = std::max(x_high - x_low, 0.5 * most) + 2 * margin,
                     high = std::max(y_high - y_low, 0.5 * most) + 2 * margin;
        x0_ = 0.5 * (x_low + x_high - wide), y0_ = 0.5 * (y_low + y_high - high);
        scale_ = std::min(room_x / wide, room_y / high);
        width_ = wide * scale_, height_ = high * scale_;
    }
    using coordinates = std::function<std::array<double, 2>(const contour_sample&)>;
    void line(const std::vector<contour_sample>& all, std::string_view style, const coordinates& of) {
        std::string points;
        for (const contour_sample& s : all) {
            const auto [x, y] = of(s);
            points += fmt::format("{:.2f},{:.2f} ", px(x), py(y));
        }
        body_ += fmt::format("<polyline class=\"{}\" points=\"{}\"/>\n", style, points);
    }
    void dot(double x, double y, double radius, std::string_view style) {
        body_ += fmt::format("<circle class=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>\n", style, px(x),
                             py(y), radius);
    }
    /// From one place to another for each sample.
    void spines(const std::vector<contour_sample>& all, std::string_view style, const coordinates& from,
                const coordinates& to) {
        std::string path;
        for (const contour_sample& s : all) {
            const auto [x, y] = from(s);
            const auto [u, v] = to(s);
            path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", px(x), py(y), px(u), py(v));
        }
        body_ += fmt::format("<path class=\"{}\" d=\"{}\"/>\n", style, path);
    }
    /// A bar of this length [m] with its name, below the window at its right end.
    void bar(double length, std::string_view name) {
        const double w = length * scale_, x = left + width_ - w, y = top + height_ + 33;
        bar_ = fmt::format("<path class=\"scale\" d=\"M{0:.1f} {1:.1f}v8m0 -4h{2:.2f}m0 -4v8\"/>"
                           "<text class=\"scale\" x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
                           x, y - 4, w, x - 6, y + 4, name);
    }
    std::string svg(std::string_view label) const {
        const double w = left + width_ + 12, h = top + height_ + 44;
        std::string grid, text;
        const double step = round_up(std::max(width_, height_) / scale_ / unit_ / 6);
        for (double k = std::ceil(x0_ / unit_ / step); k * step * unit_ <= x0_ + width_ / scale_; ++k) {
            const double at = px(k * step * unit_);
            grid += fmt::format("M{:.1f} {}v{:.1f}", at, top, height_);
            text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", at, top + height_ + 17,
                                tick(k * step));
        }
        for (double k = std::ceil(y0_ / unit_ / step); k * step * unit_ <= y0_ + height_ / scale_; ++k) {
            const double at = py(k * step * unit_);
            grid += fmt::format("M{} {:.1f}h{:.1f}", left, at, width_);
            text += fmt::format("<text class=\"y\" x=\"{}\" y=\"{:.1f}\">{}</text>", left - 6, at + 4,
                                tick(k * step));
        }
        text +=
            fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{} [{}]</text><text transform=\"translate(13 {:.1f}) "
                        "rotate(-90)\">{} [{}]</text>",
                        bar_.empty() ? left + width_ / 2 : left + 22, top + height_ + 37, across_, unit_name_,
                        top + height_ / 2, up_, unit_name_);
        return fmt::format(
            "<svg class=\"plane\" viewBox=\"0 0 {0:.0f} {1:.0f}\" role=\"img\" aria-label=\"{2}\">\n"
            "<clipPath id=\"c{8}\"><rect x=\"{3}\" y=\"{4}\" width=\"{5:.1f}\" height=\"{6:.1f}\"/></clipPath>"
            "<path class=\"grid\" d=\"{7}\"/><rect class=\"frame\" x=\"{3}\" y=\"{4}\" width=\"{5:.1f}\" "
            "height=\"{6:.1f}\"/>\n<g clip-path=\"url(#c{8})\">{9}</g>\n<g class=\"ticks\">{10}</g></svg>\n",
            w, h, label, left, top, width_, height_, grid, label[0], body_, text + bar_);
    }

private:
    static constexpr double left = 62, top = 8, room_x = 500, room_y = 440;
    static std::string tick(double v) { return fmt::format("{:.6g}", std::abs(v) < 1e-9 ? 0.0 : v); }
    double px(double x) const { return left + (x - x0_) * scale_; }
    double py(double y) const { return top + height_ - (y - y0_) * scale_; }

    double unit_, x0_ = 0, y0_ = 0, scale_ = 1, width_ = 0, height_ = 0;
    std::string unit_name_, body_, bar_;
    char across_, up_;
};

struct drawn_plot {
    std::string svg, caption;
};

/// The two axes in which the path is largest.
struct view {
    int across = 0, up = 1;
    explicit view(const std::vector<contour_sample>& all) {
        for (int axis = 0; axis < 3; ++axis) {
            range_[std::size_t(axis)] = {HUGE_VAL, -HUGE_VAL};
            auto& [low, high] = range_[std::size_t(axis)];
            for (const contour_sample& s : all)
                low = std::min(low, s.path[axis]), high = std::max(high, s.path[axis]);
        }
        if (size(2) > std::min(size(0), size(1))) (size(0) < size(1) ? across : up) = 2;
        if (across > up) std::swap(across, up);
    }
    double low(int axis) const { return range_[std::size_t(axis)][0]; }
    double high(int axis) const { return range_[std::size_t(axis)][1]; }
    double size(int axis) const { return high(axis) - low(axis); }
    std::array<double, 2> operator()(quadrant::path::point p) const { return {p[across], p[up]}; }
    plane paper(double x0, double x1, double y0, double y1, double unit, std::string_view unit_name) const {
        return {x0, x1, y0, y1, unit, unit_name, char('x' + across), char('x' + up)};
    }

private:
    std::array<std::array<double, 2>, 3> range_{};
};

/// The whole path; what the table is off by is drawn larger, so that it takes a twentieth of the window.
inline drawn_plot whole_path(const run_outcome& r, const std::vector<contour_sample>& all, const view& seen) {
    double most = 0;
    for (const contour_sample& s : all) most = std::max(most, std::hypot(seen(s.off)[0], seen(s.off)[1]));
    const double size = std::max({seen.size(seen.across), seen.size(seen.up), 1e-6});
    const double factor = most > 0 ? std::max(1.0, round_down(0.06 * size / most)) : 1;
    plane p = seen.paper(seen.low(seen.across), seen.high(seen.across), seen.low(seen.up), seen.high(seen.up),
                         1e-3, "mm");
    const auto path = [&](const contour_sample& s) { return seen(s.path); };
    const auto foot = [&](const contour_sample& s) { return seen(s.foot); };
    const auto table = [&](const contour_sample& s) { return seen(s.foot + factor * s.off); };
    const bool whole =
        r.samples < 8 * all.size(); // else lines from sample to sample would cut the corners of the path
    if (whole) {
        p.line(all, "path", path);
        p.line(all, "table", table);
    } else
        p.spines(all, "table", foot, table);
    p.dot(seen(r.worst_place)[0], seen(r.worst_place)[1], 6, "worst");
    if (most > 0) {
        const double shown = round_up(0.5 * most);
        p.bar(factor * shown, fmt::format("{} µm off the path", number(1e6 * shown)));
    }
    return {p.svg("Path and table, the distance between them enlarged"),
            fmt::format("{}, its distance from the path drawn {:.0f} times larger. Ring: the largest error.",
                        whole ? "Grey: the path. Blue: the table"
                              : "Each line from the path to the table, at the worst place of a stretch of time",
                        factor)};
}

/// Around the worst place, nothing enlarged.
inline drawn_plot worst_place(const run_outcome& r, const view& seen) {
    const double around = std::max(12 * r.contour.most, 1e-7);
    const quadrant::path::point o = r.worst_place;
    std::vector<contour_sample> near;
    for (const contour_sample& s : r.worst)
        if (distance(s.foot, o) < 3 * around) near.push_back(s);
    const bool fine = around < 0.5e-3;
    plane p = seen.paper(-around, around, -around, around, fine ? 1e-6 : 1e-3, fine ? "µm" : "mm");
    const auto table = [&](const contour_sample& s) { return seen(s.foot + s.off - o); };
    p.line(near, "path", [&](const contour_sample& s) { return seen(s.path - o); });
    p.line(near, "table", table);
    for (const contour_sample& s : near) p.dot(table(s)[0], table(s)[1], 2, "sample");
    p.dot(0, 0, 6, "worst");
    return {p.svg("The worst place, in true proportion"),
            fmt::format("The worst place ({} s, line {}: x {}, y {}, z {} mm), in true proportion; a dot for "
                        "each servo period.",
                        number(r.contour.time), r.contour.line, number(1e3 * o.x), number(1e3 * o.y),
                        number(1e3 * o.z))};
}

} // namespace quadrant_cnc
