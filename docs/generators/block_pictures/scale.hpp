// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "draw.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace block_pictures {

struct point {
    double x, y;
};

/// The points of a curve that the eye needs: no dropped one is further than a fifth of a pixel from what is
/// drawn.
inline std::vector<point> simplified(const std::vector<point>& all) {
    std::vector<bool> keep(all.size(), false);
    std::vector<std::pair<std::size_t, std::size_t>> open;
    if (!all.empty()) {
        keep.front() = keep.back() = true;
        open.emplace_back(0, all.size() - 1);
    }
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        const point a = all[from], b = all[to];
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        double most = 0.2;
        std::size_t furthest = from;
        for (std::size_t i = from + 1; i < to; ++i) {
            const double along = length == 0
                                     ? 0
                                     : ((all[i].x - a.x) * (b.x - a.x) + (all[i].y - a.y) * (b.y - a.y)) /
                                           (length * length),
                         within = std::clamp(along, 0.0, 1.0);
            const double away =
                std::hypot(all[i].x - a.x - within * (b.x - a.x), all[i].y - a.y - within * (b.y - a.y));
            if (away > most) most = away, furthest = i;
        }
        if (furthest == from) continue;
        keep[furthest] = true;
        open.emplace_back(from, furthest);
        open.emplace_back(furthest, to);
    }
    std::vector<point> kept;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (keep[i]) kept.push_back(all[i]);
    return kept;
}

/// A line of the grid; a fine one has no label.
struct tick {
    double at;
    std::string label;
};

/// From a quantity to pixels.
class scale {
public:
    scale(const panel& p, bool is_x, double low_end, double high_end)
        : log_(is_x ? p.log_x : p.log_y), low_end_(low_end), high_end_(high_end),
          degrees_(!is_x && p.y_label.ends_with("[deg]")) {
        low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
        for (const line& l : p.lines)
            for (const double v : is_x ? l.x : l.y)
                if (std::isfinite(v) && (!log_ || v > 0)) low_ = std::min(low_, v), high_ = std::max(high_, v);
        const auto& given = is_x ? p.x_range : p.y_range;
        if (given)
            std::tie(low_, high_) = *given;
        else if (!is_x && !log_) { // room above and below
            const double room = high_ > low_ ? 0.06 * (high_ - low_) : 1;
            low_ -= room, high_ += room;
        }
    }
    /// Far outside is just outside, where the frame cuts it off.
    double operator()(double v) const {
        if (std::isnan(v)) return v;
        const double share =
            log_ ? std::log(std::max(v, 1e-300) / low_) / std::log(high_ / low_) : (v - low_) / (high_ - low_);
        return low_end_ + (high_end_ - low_end_) * std::clamp(share, -1.0, 2.0);
    }
    std::vector<tick> ticks() const { return log_ ? decades() : steps(); }

private:
    std::vector<tick> steps() const {
        const double wanted = std::abs(high_end_ - low_end_) / (low_end_ < high_end_ ? 70 : 32);
        double step = std::pow(10, std::floor(std::log10((high_ - low_) / wanted)));
        for (const double factor : {2.0, 2.5, 2.0}) // 1, 2, 5, 10
            if ((high_ - low_) / step > wanted) step *= factor;
        if (degrees_) step = high_ - low_ > 400 ? 180 : high_ - low_ > 210 ? 90 : 45;
        std::vector<tick> all;
        for (double i = std::ceil(low_ / step - 1e-9); i * step <= high_ + 1e-9 * step; ++i)
            all.push_back({(*this)(i * step), fmt::format("{:.6g}", i == 0 ? 0.0 : i * step)});
        return all;
    }
    std::vector<tick> decades() const {
        const double wide = std::log10(high_ / low_);
        std::vector<tick> all;
        for (double decade = std::pow(10, std::floor(std::log10(low_))); decade <= high_; decade *= 10)
            for (int i = 1; i < 10; ++i) {
                const double v = i * decade;
                if (v < low_ * (1 - 1e-9) || v > high_ * (1 + 1e-9)) continue;
                const bool named =
                    i == 1 || (wide < 2.6 && (i == 2 || i == 5)) || (wide < 1.1 && (i == 3 || i == 7));
                all.push_back({(*this)(v), named ? fmt::format("{:.6g}", v) : ""});
            }
        return all;
    }

    bool log_;
    double low_end_, high_end_, low_, high_;
    bool degrees_;
};

} // namespace block_pictures
