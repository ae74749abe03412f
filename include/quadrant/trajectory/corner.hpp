// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "path_shape.hpp"
#include "speed_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0::trajectory {

/// What a stretch of path is to the speed along it: one segment, or several that follow smoothly.
struct stretch {
    double length; ///< [m]
    path_shape shape;
    bounds within; ///< of the speed along it
    path::point first_tangent, first_curvature, last_tangent, last_curvature;

    stretch(const path::segment& of, double feed, const plain_limits& machine) noexcept
        : length(of.length()), shape(of), within(along_path(shape, feed, machine)),
          first_tangent(of.tangent(0)), first_curvature(of.curvature(0)), last_tangent(of.tangent(length)),
          last_curvature(of.curvature(length)) {}

    /// Tangent and curvature go on without a jump.
    bool goes_on_in(const stretch& next) const noexcept {
        return distance(last_tangent, next.first_tangent) < 1e-9 &&
               distance(last_curvature, next.first_curvature) <= 1e-6 * (shape.curved + next.shape.curved);
    }
    /// Both as one, with the tighter limits.
    stretch joined(const stretch& next) const noexcept {
        stretch both = *this;
        both.length += next.length;
        for (int i = 0; i < 3; ++i) {
            both.shape.slope[i] = std::max(shape.slope[i], next.shape.slope[i]);
            both.shape.bend[i] = std::max(shape.bend[i], next.shape.bend[i]);
            both.shape.twist[i] = std::max(shape.twist[i], next.shape.twist[i]);
        }
        both.shape.curved = std::max(shape.curved, next.shape.curved);
        both.within = {std::min(within.velocity, next.within.velocity),
                       std::min(within.acceleration, next.within.acceleration),
                       std::min(within.jerk, next.within.jerk)};
        both.last_tangent = next.last_tangent;
        both.last_curvature = next.last_curvature;
        return both;
    }
};

/// How a joint of two pieces is driven through without a stop: the end of the first and the beginning of the
/// second at the same time. While the speed along the first falls from v to 0 within a time tau, that along the
/// second rises from 0 to v:
///   r = r1(s1) + r2(s2) - P,   r' = v ((1 - g) t1 + g t2),   r'' = v/tau g' (t2 - t1) + curvatures
/// with the joint P and g(t/tau) the speed change of the profile kind with two ramps. Position, velocity and
/// acceleration are continuous at any joint (corner, jump of curvature), the velocity of an axis stays between
/// its two values, and
///   g1 v |t2 - t1| / tau + 1.13 k v^2 <= A,   g2 v |t2 - t1| / tau^2 + c v^2/tau + k' v^3 <= J    (each axis)
/// give the shortest tau for a speed. Each piece is left, or reached, v tau/2 from P; in the middle both are d
/// = m v tau from it (m = 1/12, cubic 0.075), so that neither path nor P is further away than d |t2 - t1| +
/// 0.75 (k1 + k2) d^2.
/// Source: [Tajima2016] (a transition of velocity between two lines within the limits of the axes, duration
/// from the tolerance); curved pieces, and the constants of their terms, by the bounds in docs/trajectory.md.
/// Plain SI numbers; never throws or allocates.
class corner {
public:
    corner() = default; ///< a stop
    corner(const stretch& before, const stretch& after, double tolerance, profile_kind kind,
           const plain_limits& machine) noexcept
        : kind_(kind) {
        const path::point turn = after.first_tangent - before.last_tangent;
        turn_ = magnitude(turn);
        curved_ = before.shape.curved + after.shape.curved;
        smooth_ = before.goes_on_in(after);
        const bool cubic = kind == profile_kind::cubic_acceleration;
        for (int i = 0; i < 3; ++i) {
            const double k1 = before.shape.bend[i], k2 = after.shape.bend[i];
            const double one = cubic ? 4.56 : 3.89, both = cubic ? 6.17 : 6.67;
            axis_[std::size_t(i)] = {
                std::abs(turn[i]), 1.13 * std::max(k1, k2), std::min(one * (k1 + k2), both * std::max(k1, k2)),
                std::max(before.shape.twist[i], after.shape.twist[i]), machine.axis[std::size_t(i)]};
        }
        axis_[3] = {turn_, 0, 0, 0, machine.path}; // the vector, for what is asked along the path
        straight_ = !(curved_ > 0);
        if (straight_) join_straight();
        const double room = 0.5 * std::min(before.length, after.length);
        const double high = std::min({before.within.velocity, after.within.velocity, 1e9});
        most_ = passes(high, tolerance, room) ? high
                : straight_                   ? passed_straight(high, tolerance, room)
                                              : passed(high, tolerance, room);
    }

    double most() const noexcept { return most_; } ///< highest speed [m/s]; 0: a stop
    /// Shortest time of the transition [s]; infinite when no time keeps the limits. Never falls with the speed.
    double time(double v) const noexcept {
        if (smooth_ || !(v > 0)) return 0;
        if (straight_) return std::max(v * per_speed_, std::sqrt(v * per_root_));
        const double g1 = slope_peak, g2 = bend_peak();
        double longest = 0;
        for (const part& p : axis_) {
            if (p.within.acceleration < unlimited) {
                const double left = p.within.acceleration - p.bend * v * v;
                if (!(left > 0)) return unlimited;
                longest = std::max(longest, g1 * v * p.turn / left);
            }
            if (p.within.jerk < unlimited) {
                const double left = p.within.jerk - p.twist * v * v * v, c = g2 * v * p.turn,
                             b = p.bending * v * v;
                if (!(left > 0)) return unlimited;
                longest = std::max(longest, (b + std::sqrt(b * b + 4 * c * left)) / (2 * left));
            }
        }
        return longest;
    }
    /// How far from the joint the transition begins on the one piece and ends on the other [m].
    double leg(double v) const noexcept { return 0.5 * v * time(v); }
    /// Bound of the distance from the joint and from the path [m].
    double deviation(double v) const noexcept { return off(v * time(v)); }
    double turn() const noexcept {
        return turn_;
    } ///< |t2 - t1|: twice the sine of half the angle of the corner
    /// The speed along the piece that is left; seen backwards in time, along the one that is reached.
    speed_change falling(double v) const noexcept {
        const double tau = time(v);
        return {v, 0, tau, 0.5 * tau, kind_ == profile_kind::cubic_acceleration};
    }
    speed_change rising(double v) const noexcept {
        const double tau = time(v);
        return {0, v, tau, 0.5 * tau, kind_ == profile_kind::cubic_acceleration};
    }

private:
    struct part {
        double turn = 0, bend = 0, bending = 0, twist = 0;
        bounds within;
    };
    static constexpr double slope_peak = 2; ///< g1: the most of g'
    double bend_peak() const noexcept {     ///< g2: the most of g''
        return kind_ == profile_kind::cubic_acceleration ? 6 : 4;
    }
    double share() const noexcept { ///< m: how far from the joint, in the middle, of v tau
        return kind_ == profile_kind::cubic_acceleration ? 0.075 : 1.0 / 12;
    }
    /// The deviation of a transition that is v tau long.
    double off(double way) const noexcept {
        const double d = share() * way;
        return smooth_ ? 0 : d * (turn_ + 0.75 * curved_ * d);
    }
    bool passes(double v, double tolerance, double room) const noexcept {
        const double way = v * time(v);
        return 0.5 * way <= room && off(way) <= tolerance;
    }
    /// Between two lines tau is the longer of v a and sqrt(v b), of all axes together.
    void join_straight() noexcept {
        for (const part& p : axis_) {
            per_speed_ = std::max(per_speed_, slope_peak * p.turn / p.within.acceleration);
            per_root_ = std::max(per_root_, bend_peak() * p.turn / p.within.jerk);
        }
    }
    /// The highest speed below `high` that passes between two lines: v tau(v) = way, solved.
    double passed_straight(double high, double tolerance, double room) const noexcept {
        const double way = std::min(2 * room, tolerance / (share() * turn_)) * (1 - 1e-12);
        const double by_acceleration = std::sqrt(way / per_speed_), by_jerk = std::cbrt(way * way / per_root_);
        return std::min({high, by_acceleration, by_jerk});
    }
    double passed(double high, double tolerance, double room) const noexcept {
        double low = 0;
        for (int i = 0; i < 24; ++i) {
            const double middle = 0.5 * (low + high);
            if (middle <= low || middle >= high) break;
            (passes(middle, tolerance, room) ? low : high) = middle;
        }
        return low;
    }

    profile_kind kind_ = profile_kind::trapezoidal_acceleration;
    bool smooth_ = false, straight_ = false;
    double turn_ = 0, curved_ = 0, most_ = 0, per_speed_ = 0, per_root_ = 0; ///< tau/v, tau^2/v between lines
    std::array<part, 4> axis_{};
};

} // namespace quadrant::inline v0::trajectory
