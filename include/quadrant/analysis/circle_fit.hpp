// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "estimated.hpp"
#include "least_squares.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

/// A run along a circle, its one whole turn, and the circles that lie best in it: what `circular_test` is made
/// of.
namespace quadrant::inline v0::analysis {

/// One run along a circle, both encoders sampled together at constant feed.
struct circular_path {
    std::vector<displacement> x, y;
    duration period;
};
/// A circle in the plane of both axes: its centre and its radius [m].
struct circle {
    displacement x{}, y{}, radius{};
};

namespace detail {
inline double turn_degrees(double y, double x) {
    const double a = std::atan2(y, x) * 180 / std::numbers::pi;
    return a < 0 ? a + 360 : a;
}
inline double range_about(const std::vector<double>& x, const std::vector<double>& y, double a, double b) {
    double low = HUGE_VAL, high = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double r = (x[i] - a) * (x[i] - a) + (y[i] - b) * (y[i] - b);
        low = std::min(low, r), high = std::max(high, r);
    }
    return std::sqrt(high) - std::sqrt(low);
}
/// Least range of the radius: convex near the centre, not smooth; a search along turning directions.
inline double least_range(const std::vector<double>& x, const std::vector<double>& y, double a, double b) {
    double best = range_about(x, y, a, b), step = best, direction = 0;
    for (int stuck = 0; step > 1e-6 * best && step > 0;) {
        direction += 2.399963229728653; // golden angle: no direction comes twice
        const double da = step * std::cos(direction), db = step * std::sin(direction);
        const double now = range_about(x, y, a + da, b + db);
        if (now < best)
            best = now, a += da, b += db, stuck = 0;
        else if (++stuck == 12)
            step *= 0.6, stuck = 0;
    }
    return best;
}
/// Gauss-Newton on r = R + a cos + b sin.
inline std::array<double, 3> fit_circle(const std::vector<double>& x, const std::vector<double>& y,
                                        std::array<double, 3> start) {
    for (int round = 0; round < 10; ++round) {
        least_squares equations(3);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double dx = x[i] - start[0], dy = y[i] - start[1], r = std::hypot(dx, dy);
            equations.add({dx / r, dy / r, 1}, r - start[2]);
        }
        const auto step = equations.solve().x;
        for (std::size_t i = 0; i < 3; ++i) start[i] += step[i];
        if (std::hypot(step[0], step[1], step[2]) < 1e-13 * start[2]) break;
    }
    return start;
}

struct full_turn {
    std::vector<double> x, y, angle; ///< angle unwrapped, rising whichever way it went
    bool counterclockwise;
};
/// The middle turn of the run: what comes before and after (run in, run out) is cut off evenly.
inline full_turn one_turn(const circular_path& path, const circle& nominal) {
    require_positive("circular_path.period", path.period);
    require(path.x.size() == path.y.size(), "circular_path.x", double(path.x.size()),
            "must hold as many samples as circular_path.y (" +
                quadrant::detail::shortest(double(path.y.size())) + ")");
    require(path.x.size() >= 100, "circular_path.x", double(path.x.size()), "must hold 100 samples or more");
    require_positive("circular_options.nominal.radius", nominal.radius);
    std::vector<double> angle;
    double last = 0, sum = 0, back = 0;
    for (std::size_t i = 0; i < path.x.size(); ++i) {
        const double dx = (path.x[i] - nominal.x).value(), dy = (path.y[i] - nominal.y).value();
        const double off = std::hypot(dx, dy) - nominal.radius.value();
        require(std::isfinite(off) && std::abs(off) < 0.2 * nominal.radius.value(), "circular_path",
                quadrant::detail::in_unit(off, " m"),
                "must stay within a fifth of the nominal radius of the nominal circle (sample " +
                    quadrant::detail::shortest(double(i)) + ")");
        const double now = turn_degrees(dy, dx);
        double step = i == 0 ? 0 : now - last;
        if (step > 180) step -= 360;
        if (step < -180) step += 360;
        require(std::abs(step) < 20, "circular_path.step", quadrant::detail::in_unit(step, " degrees"),
                "must turn less than 20 degrees a sample");
        sum += step, last = now;
        angle.push_back(i == 0 ? now : angle.back() + step);
    }
    const bool forward = sum > 0;
    for (std::size_t i = 1; i < angle.size(); ++i)
        back = std::max(back, forward ? angle[i - 1] - angle[i] : angle[i] - angle[i - 1]);
    require(std::abs(sum) >= 360 - 1e-6 - 2 * std::abs(sum) / double(angle.size()), "circular_path, turned",
            quadrant::detail::in_unit(sum, " degrees"),
            "must be a full turn (360 degrees) or more, run in and run out included");
    require(back < 2, "circular_path, turned back", quadrant::detail::in_unit(back, " degrees"),
            "must go one way round");
    const double cut = std::max(0.0, 0.5 * (std::abs(sum) - 360));
    full_turn out{{}, {}, {}, forward};
    for (std::size_t i = 0; i < angle.size(); ++i) {
        const double travelled = std::abs(angle[i] - angle.front());
        if (travelled < cut || travelled >= cut + 360) continue;
        out.x.push_back(path.x[i].value()), out.y.push_back(path.y[i].value()), out.angle.push_back(angle[i]);
    }
    return out;
}
} // namespace detail

} // namespace quadrant::inline v0::analysis
