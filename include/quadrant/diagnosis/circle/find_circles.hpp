// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/log.hpp"
#include "../text/bad_input.hpp"
#include "run.hpp"

#include <algorithm>
#include <utility>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Where a reference moves at constant speed along circles, from the reference alone: pieces of constant speed,
/// in each of them the longest stretches that keep to the circle through 60 degrees of their beginning.
class circle_search {
public:
    circle_search(const std::vector<double>& x, const std::vector<double>& y, double written)
        : x_(x), y_(y), written_(std::max(written, 1e-12)) {}

    std::vector<followed_circle> operator()() {
        set_stride();
        std::vector<followed_circle> found;
        for (std::size_t k = 0; k + 2 * stride_ < x_.size();) {
            const std::size_t end = end_of_constant_speed(k);
            if (end < k + 8 * stride_) {
                k += stride_;
                continue;
            }
            search(k, end, found);
            k = end;
        }
        return found;
    }

private:
    double step(std::size_t k) const { return std::hypot(x_[k + stride_] - x_[k], y_[k + stride_] - y_[k]); }

    /// So many samples that the rounding of the reference leaves its speed within a hundredth.
    void set_stride() {
        const std::size_t longest = x_.size() / 64 + 1;
        for (stride_ = 1; 2 * stride_ < longest; stride_ *= 2) {
            std::vector<double> steps;
            for (std::size_t k = 0; k + stride_ < x_.size(); k += stride_) steps.push_back(step(k));
            const auto most = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() * 9 / 10);
            std::nth_element(steps.begin(), most, steps.end());
            if (*most > 400 * written_ || *most == 0) break;
        }
    }
    std::size_t end_of_constant_speed(std::size_t k) const {
        const double speed = step(k), leeway = 0.02 * speed + 4 * written_;
        if (speed < 20 * written_) return k;
        std::size_t end = k + stride_;
        while (end + stride_ < x_.size() && std::abs(step(end) - speed) < leeway) end += stride_;
        return end;
    }
    /// How many samples from k on turn the heading by 60 degrees; past the end when they never do.
    std::size_t sixth_of_a_turn(std::size_t k, std::size_t end) const {
        const auto heading = [&](std::size_t i) {
            return std::atan2(y_[i + stride_] - y_[i], x_[i + stride_] - x_[i]);
        };
        const double begin = heading(k);
        double now = begin;
        for (std::size_t i = k; i + stride_ < end; i += stride_) {
            now = unwrapped(heading(i), now);
            if (std::abs(now - begin) > std::numbers::pi / 3) return i + 1 - k;
        }
        return end;
    }
    void search(std::size_t k, std::size_t end, std::vector<followed_circle>& found) const {
        while (k < end) {
            const std::size_t window = sixth_of_a_turn(k, end);
            if (k + window > end || window < 8) return;
            followed_circle c = circle_through(x_, y_, k, k + window);
            const auto on = [&](std::size_t i) {
                return std::abs(std::hypot(x_[i] - c.x, y_[i] - c.y) - c.radius) <
                       2e-4 * c.radius + 4 * written_;
            };
            const bool whole = on(k) && on(k + window / 2) && on(k + window - 1);
            while (whole && c.last < end && on(c.last)) ++c.last;
            c.turned = whole ? turned(x_, y_, c) : 0;
            if (std::abs(c.turned) < 0.99 * two_pi) {
                k += std::max(window / 2, stride_);
                continue;
            }
            const std::size_t last = c.last;
            c = circle_through(x_, y_, c.first, last);
            c.turned = turned(x_, y_, c);
            found.push_back(c);
            k = last;
        }
    }

    const std::vector<double>&x_, &y_;
    double written_;
    std::size_t stride_ = 1;
};

} // namespace detail

/// The two axes of a log that move, in the order of their names: the first is called x below.
/// Throws bad_input where there are not two.
inline std::pair<const axis_log*, const axis_log*> circle_axes(const machine_log& log) {
    std::vector<const axis_log*> moving;
    for (const axis_log& a : log.axes)
        if (!a.still) moving.push_back(&a);
    if (moving.size() != 2)
        throw bad_input(log.file, fmt::format("a circle needs two axes that move, here {} {}", moving.size(),
                                              moving.size() == 1 ? "does" : "do"));
    return {moving[0], moving[1]};
}

/// Every whole circle at constant feed in a log, found from the references: one run each. What comes before its
/// last whole turns is run in. Throws bad_input where there is none.
inline std::vector<circle_run> find_circles(const machine_log& log, std::size_t number = 0) {
    const auto [x, y] = circle_axes(log);
    const double written = std::max(x->reference_step, y->reference_step), period = log.sample_period_s;
    std::vector<circle_run> runs;
    for (const auto& c : detail::circle_search(x->reference, y->reference, written)()) {
        circle_run r;
        r.file = log.file, r.log = number, r.period_s = period;
        r.radius = c.radius, r.counterclockwise = c.turned > 0;
        r.feed = c.radius * std::abs(c.turned) / (double(c.last - c.first - 1) * period);
        r.resolution = std::max(x->position_step, y->position_step);
        double angle = 0;
        for (std::size_t k = c.first; k < c.last; ++k) {
            const double dx = x->position[k] - c.x, dy = y->position[k] - c.y;
            const double now = std::atan2(dy, dx);
            angle = r.angle.empty() ? now : detail::unwrapped(now, angle);
            r.angle.push_back(angle);
            r.deviation.push_back(std::hypot(dx, dy) - c.radius);
        }
        const std::size_t skip = detail::cut_to_whole_turns(r.angle, r.turns);
        if (r.turns == 0) continue;
        r.angle.erase(r.angle.begin(), r.angle.begin() + static_cast<std::ptrdiff_t>(skip));
        r.deviation.erase(r.deviation.begin(), r.deviation.begin() + static_cast<std::ptrdiff_t>(skip));
        r.start_s = double(c.first + skip) * period;
        runs.push_back(std::move(r));
    }
    if (runs.empty())
        throw bad_input(
            log.file, fmt::format("axes {} and {} follow no whole circle at constant feed", x->name, y->name));
    return runs;
}

} // namespace quadrant::inline v0::diagnosis
