// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "limits.hpp"

#include <algorithm>
#include <cmath>

namespace quadrant::inline v0::trajectory {

/// Position along the path and its time derivatives [m, m/s, m/s^2, m/s^3].
struct path_motion {
    double s = 0, v = 0, a = 0, j = 0;
};

/// From one speed to another, at rest in acceleration at both ends: the acceleration goes up along a ramp,
/// stays, and goes down along the same ramp; its peak is (to - from) / (duration - ramp). Half the change of
/// speed is made in half the time, so that the distance is (from + to)/2 duration whatever the ramp.
/// Ramp of the acceleration, x = t / ramp: x (trapezoidal) or 3 x^2 - 2 x^3 (cubic, jerk 1.5 times the mean at
/// x = 1/2).
/// Source: [ErkorkmazAltintas2001] (trapezoidal), [Yeung2006] (the kinds), the cubic ramp is the smoothstep
/// polynomial. Plain SI numbers; never throws or allocates.
struct speed_change {
    double from = 0, to = 0, duration = 0, ramp = 0; ///< [m/s, m/s, s, s]; ramp is at most duration / 2
    bool cubic = false;

    /// The same, slower: all derivatives become smaller.
    speed_change stretched(double longer) const noexcept {
        return {from, to, longer, duration > 0 ? ramp * (longer / duration) : 0, cubic};
    }

    double distance() const noexcept { return 0.5 * (from + to) * duration; } ///< [m]

    path_motion at(double t) const noexcept { ///< t [s] is held to 0 ... duration
        t = std::clamp(t, 0.0, duration);
        const double left = duration - t;
        if (t < ramp) return ramped(from, t, 1);
        if (left < ramp) {
            const path_motion back = ramped(to, left, -1);
            return {distance() - back.s, back.v, -back.a, back.j};
        }
        if (duration <= ramp) return {0, to, 0, 0};
        const double a = peak(), held = t - ramp, v0 = from + 0.5 * a * ramp;
        const double s0 = ramp * (from + a * ramp * (cubic ? 0.15 : 1.0 / 6));
        return {s0 + held * (v0 + 0.5 * a * held), v0 + a * held, a, 0};
    }

private:
    double peak() const noexcept { return (to - from) / (duration - ramp); } ///< of the acceleration
    /// The first ramp, t after its start (way 1), or the last one seen backwards in time (way -1).
    path_motion ramped(double v0, double t, double way) const noexcept {
        const double a = way * peak(), x = t / ramp, x2 = x * x;
        if (!cubic) return {t * (v0 + a * t * x / 6), v0 + 0.5 * a * t * x, a * x, a / ramp};
        return {t * (v0 + a * t * x2 * (0.25 - 0.1 * x)), v0 + a * t * x2 * (1 - 0.5 * x), a * x2 * (3 - 2 * x),
                a / ramp * 6 * x * (1 - x)};
    }
};

/// The shortest changes of speed within an acceleration and a jerk, as far as a kind of profile knows them.
class quickest_change {
public:
    quickest_change() = default;
    quickest_change(profile_kind kind, const bounds& within) noexcept
        : cubic_(kind == profile_kind::cubic_acceleration) {
        if (kind != profile_kind::constant_velocity) acceleration_ = within.acceleration;
        if (kind >= profile_kind::trapezoidal_acceleration)
            jerk_ = cubic_ ? within.jerk / 1.5 : within.jerk; // of a straight ramp as long as the cubic one
        square_ = acceleration_ * acceleration_;
        if (jerk_ < unlimited) whole_ramp_ = acceleration_ / jerk_;
    }
    /// Without limits both formulae give no time.
    speed_change operator()(double from, double to) const noexcept {
        const double dv = std::abs(to - from);
        if (dv * jerk_ >= square_) return {from, to, dv / acceleration_ + whole_ramp_, whole_ramp_, cubic_};
        const double ramp = std::sqrt(dv / jerk_); // the acceleration is not reached
        return {from, to, 2 * ramp, ramp, cubic_};
    }

private:
    double acceleration_ = unlimited, jerk_ = unlimited, square_ = unlimited,
           whole_ramp_ = 0; ///< up to the whole acceleration [s]
    bool cubic_ = false;
};

/// The highest x between `low` and `high` that leaves some slack, for a slack that falls with x: not below 0
/// and at most `enough` where it is returned. Regula falsi (Illinois), halving where a slack is not finite;
/// `low` where nothing is left.
template <class Slack> double highest(double low, double high, double enough, Slack slack) noexcept {
    double above = slack(high);
    if (above >= 0) return high;
    double below = slack(low);
    if (!(below > enough)) return low;
    const double aim = 0.5 * enough; // a little inside
    double weight_below = below - aim, weight_above = aim - above;
    for (int i = 0; i < 100; ++i) {
        double x = low + (high - low) * (weight_below / (weight_below + weight_above));
        if (!(x > low && x < high)) x = 0.5 * (low + high);
        if (x <= low || x >= high) break;
        const double left = slack(x);
        if (left >= 0 && left <= enough) return x;
        if (left >= 0) {
            low = x;
            weight_below = left - aim;
            weight_above *= 0.5;
        } else {
            high = x;
            weight_above = aim - left;
            weight_below *= 0.5;
        }
    }
    return low;
}

} // namespace quadrant::inline v0::trajectory
