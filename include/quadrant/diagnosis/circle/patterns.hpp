// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

/// What each error leaves in the radius. With e = (e_x, e_y) how far the machine stands off its reference,
///   r = e_x cos t + e_y sin t,   velocity (-s v sin t, s v cos t),   s = 1 counterclockwise, -1 clockwise
namespace quadrant::inline v0::diagnosis::detail {

/// A place on a run.
struct circle_point {
    double angle = 0, feed = 0, radius = 0;
    int turning = 1;
    std::size_t run = 0, log = 0;
};

/// One column of the fit; its coefficient is in `unit`.
struct circle_pattern {
    std::string name, axis, unit;
    std::function<double(const circle_point&)> of;
    bool of_setup = false; ///< centre and length: not an error of the machine
    std::size_t group = 0; ///< of a reversal spike: feed and radius, and
    int side = 0;          ///< +1 or -1: at the positive or negative end of the axis
    double width_s = 0;    ///< of a reversal spike, at half height
};

inline double sign_of(double v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

/// The angle travelled since the axis (0: x, 1: y) last reversed, 0 ... pi, and at which of its ends that was.
struct since_reversal {
    double angle;
    int side;
};
inline since_reversal reversed(const circle_point& p, int axis) {
    const double from_x = p.angle - (axis == 0 ? 0 : std::numbers::pi / 2);
    double since = std::fmod(p.turning * from_x, std::numbers::pi);
    if (since < 0) since += std::numbers::pi;
    return {since, std::cos(from_x - p.turning * since) > 0 ? 1 : -1};
}
/// How far the nearest reversal of either axis is, in radians.
inline double from_reversal(double angle) { return std::abs(std::remainder(angle, std::numbers::pi / 2)); }

/// A reversal spike of height 1: (1 - e^(-a/rise))^order e^(-a/decay) over its peak, a the angle since the
/// reversal. That is the step of a friction force seen through a position loop; the order makes the slow
/// beginning of presliding.
struct spike_shape {
    double rise = 0.01, decay = 0.03; ///< [rad]
    int order = 1;
    double operator()(double since) const {
        if (since <= 0) return 0;
        const double q = rise / (order * decay + rise); // e^(-a/rise) at the peak
        const double risen = -std::expm1(-since / rise) / (1 - q), squared = risen * risen;
        const double all = order == 1 ? risen : order == 2 ? squared : squared * squared; // 1, 2 or 4
        return all * std::exp(-since / decay) / std::pow(q, rise / decay);
    }
    double width() const { ///< at half height
        double from = HUGE_VAL, to = 0;
        for (double a = 0; a < std::numbers::pi; a += decay / 200)
            if ((*this)(a) >= 0.5) from = std::min(from, a), to = a;
        return std::max(0.0, to - from);
    }
};

/// The errors that a coefficient each describes, those of the set-up first. `largest`: radius that a bow is
/// given for.
inline std::vector<circle_pattern> circle_patterns(circle_source source, std::size_t logs,
                                                   const std::vector<double>& radii, double largest) {
    using std::cos, std::sin;
    using point = const circle_point&;
    std::vector<circle_pattern> all;
    for (std::size_t l = 0; l < logs; ++l) {
        all.push_back({"centre", "x", "m", [l](point p) { return p.log == l ? cos(p.angle) : 0; }, true});
        all.push_back({"centre", "y", "m", [l](point p) { return p.log == l ? sin(p.angle) : 0; }, true});
    }
    if (source == circle_source::instrument) {
        for (const double r : radii)
            all.push_back({"length", "", "m",
                           [r](point p) { return std::abs(p.radius / r - 1) < 1e-3 ? 1.0 : 0.0; }, true});
        all.push_back({"scale_mismatch", "", "m/m", [](point p) { return p.radius * cos(2 * p.angle) / 2; }});
        all.push_back({"squareness", "", "rad", [](point p) { return -p.radius * sin(2 * p.angle) / 2; }});
        all.push_back({"straightness", "x", "m", [largest](point p) {
                           return -std::pow(p.radius / largest * cos(p.angle), 2) * sin(p.angle);
                       }});
        all.push_back({"straightness", "y", "m", [largest](point p) {
                           return -std::pow(p.radius / largest * sin(p.angle), 2) * cos(p.angle);
                       }});
    }
    all.push_back(
        {"servo_mismatch", "", "s", [](point p) { return p.turning * p.feed * sin(2 * p.angle) / 2; }});
    all.push_back({"radius_change", "", "s^2", [](point p) { return p.feed * p.feed / p.radius; }});
    all.push_back({"amplitude_mismatch", "", "s^2",
                   [](point p) { return p.feed * p.feed / p.radius * cos(2 * p.angle) / 2; }});
    if (source == circle_source::instrument) {
        all.push_back(
            {"lateral_play", "x", "m", [](point p) { return -0.5 * p.turning * std::abs(sin(p.angle)); }});
        all.push_back(
            {"lateral_play", "y", "m", [](point p) { return 0.5 * p.turning * std::abs(cos(p.angle)); }});
    }
    return all;
}

/// Play b: the axis stands b/2 behind its motion. Where it reverses it stays until the motor has gone all of
/// it, then follows: an outward step that stays. `passed`: the play as far as it is known, for the step's
/// width; coefficient: b.
inline circle_pattern backlash_pattern(int axis, double passed) {
    return {"backlash", axis == 0 ? "x" : "y", "m", [axis, passed](const circle_point& p) {
                const double gone = p.radius * (1 - std::cos(reversed(p, axis).angle)),
                             along = axis == 0 ? std::cos(p.angle) : std::sin(p.angle);
                const auto last = reversed(p, axis);
                return last.side * along * (passed > 0 ? std::min(gone / passed, 1.0) - 0.5 : 0.5);
            }};
}

/// The spike that an axis leaves after its reversals at one end, in the runs of one group.
inline circle_pattern spike_pattern(int axis, int side, std::size_t group,
                                    std::vector<std::size_t> group_of_run, spike_shape shape,
                                    double feed_over_radius) {
    return {"reversal_spikes",
            axis == 0 ? "x" : "y",
            "m",
            [=, groups = std::move(group_of_run)](const circle_point& p) {
                if (groups[p.run] != group) return 0.0;
                const auto last = reversed(p, axis);
                const double along = axis == 0 ? std::cos(p.angle) : std::sin(p.angle);
                return last.side == side ? shape(last.angle) * std::abs(along) : 0.0;
            },
            false,
            group,
            side,
            shape.width() / feed_over_radius};
}

} // namespace quadrant::inline v0::diagnosis::detail
