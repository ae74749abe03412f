// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "speed_change.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0::trajectory {

/// One length in the shortest time, from one speed to another, both not negative: the speed goes to the highest
/// that the limits and the length allow, stays there, and goes to the last one; no acceleration at either end.
///   D(v0, v) + D(v, v1) <= L, v <= feed: the highest v (the distances D grow with it); what is left of L is cruise.
/// Time-optimal under limits of velocity, acceleration and jerk (trapezoidal_acceleration): compared with
/// published durations of Ruckig and with a brute-force search in tests/trajectory/profile.cpp.
/// `stretch` makes it last longer: first by a lower cruise, then by a slower change, so that limits stay kept.
/// Plain SI numbers; never throws or allocates. For moves with units and errors use `profile`.
class speed_profile {
public:
    static bool feasible(profile_kind kind, const bounds& within, double length, double from,
                         double to) noexcept {
        return quickest_change(kind, within)(from, to).distance() <= length;
    }

    speed_profile() = default;
    /// Needs `feasible`, and both speeds at most that of `within`.
    speed_profile(profile_kind kind, const bounds& within, double length, double from, double to) noexcept
        : kind_(kind), change_(kind, within), length_(length), from_(from), to_(to) {
        const double low = std::max(from, to), high = std::max(low, std::min(within.velocity, 1e9));
        cruise_at(highest(low, high, 1e-13 * length, [this](double v) { return left(v); }));
    }

    /// Lasts `duration` from now on; false, and nothing changes, when that is shorter or cannot be had.
    bool stretch(double duration) noexcept {
        const double now = this->duration(), fastest = std::max(from_, to_);
        if (!(duration >= now)) return duration >= now * (1 - 1e-12);
        double low = kind_ == profile_kind::constant_velocity ? 0 : fastest, high = cruise_;
        if (low > 0 && duration > lasts(low)) {
            // Cruise at the faster end, then (or before) a change that takes longer: v T - (v - u) t/2 = L.
            const double slower = std::min(from_, to_);
            if (!(fastest > slower)) return false;
            const double change = 2 * (fastest * duration - length_) / (fastest - slower);
            if (change > duration) return false;
            cruise_at(low);
            speed_change& one = from_ < to_ ? rise_ : fall_;
            one = one.stretched(change);
            held_ = duration - change;
            return true;
        }
        for (int i = 0; i < 200; ++i) {
            const double middle = 0.5 * (low + high);
            if (middle <= low || middle >= high) break;
            (lasts(middle) > duration ? low : high) = middle;
        }
        cruise_at(high);
        return true;
    }

    double duration() const noexcept { return rise_.duration + held_ + fall_.duration; } ///< [s]
    double length() const noexcept { return length_; }                                   ///< [m]
    double cruise() const noexcept { return cruise_; } ///< highest speed [m/s]

    path_motion
    at(double t) const noexcept { ///< t [s] is held to 0 ... duration; exactly the length at its end
        if (t < rise_.duration) return rise_.at(t);
        if (t < rise_.duration + held_)
            return {rise_.distance() + cruise_ * (t - rise_.duration), cruise_, 0, 0};
        path_motion y = fall_.at(t - rise_.duration - held_);
        y.s = t < duration() ? y.s + length_ - fall_.distance() : length_;
        return y;
    }

private:
    double left(double v) const noexcept { // of the length for the cruise
        return length_ - change_(from_, v).distance() - change_(v, to_).distance();
    }
    double lasts(double v) const noexcept {
        const speed_change rise = change_(from_, v), fall = change_(v, to_);
        return rise.duration + fall.duration + cruise_time(v, rise, fall);
    }
    double cruise_time(double v, const speed_change& rise, const speed_change& fall) const noexcept {
        const double way = length_ - rise.distance() - fall.distance();
        return way > 0 ? way / v : 0;
    }
    void cruise_at(double v) noexcept {
        cruise_ = v;
        rise_ = change_(from_, v);
        fall_ = change_(v, to_);
        held_ = cruise_time(v, rise_, fall_);
    }

    profile_kind kind_ = profile_kind::trapezoidal_acceleration;
    quickest_change change_;
    double length_ = 0, from_ = 0, to_ = 0, cruise_ = 0, held_ = 0;
    speed_change rise_, fall_;
};

/// A move of one length on one line, with units: position, velocity, acceleration and jerk at any time.
/// Equations: `speed_profile` and `speed_change`; kinds: `profile_kind`.
/// `in_whole_periods` makes the duration a whole number of servo periods, by less than one period longer.
/// Throws "profile.length = ...: must ..." for what is not a move, and "line = 12: the jerk limit cannot be met
/// within the
/// block: ..." when the speed cannot go from `from` to `to` within the length.
/// Cost: about a hundred square roots to make, two dozen operations at a time to ask; 250 bytes. For a path of
/// many moves: `interpolator`. For the logistic curve of the precision stage: `s_curve`.
class profile {
public:
    /// A move: its length, its limits, and the speeds at its ends.
    struct parameters {
        quantity<si::length> length; ///< > 0
        motion_limits limits;        ///< velocity: the feed
        profile_kind kind = profile_kind::trapezoidal_acceleration;
        quantity<si::velocity> from{}; ///< 0 ... feed
        quantity<si::velocity> to{};   ///< 0 ... feed
        std::size_t line = 0;          ///< of a program, for messages
    };

    profile(const parameters& p) : given_(p) {
        require_positive("profile.length", p.length);
        require_limits("profile.limits", p.limits, p.kind);
        require_finite("profile.limits.velocity", p.limits.velocity);
        const bounds within = plain(p.limits);
        const double length = p.length.value(), from = p.from.value(), to = p.to.value();
        require(from >= 0 && from <= within.velocity, "profile.from", p.from,
                "must lie between 0 and the feed (" + quadrant::detail::shortest(p.limits.velocity) + ")");
        require(to >= 0 && to <= within.velocity, "profile.to", p.to,
                "must lie between 0 and the feed (" + quadrant::detail::shortest(p.limits.velocity) + ")");
        if (!speed_profile::feasible(p.kind, within, length, from, to)) {
            bounds free = within;
            free.jerk = unlimited;
            const double needs = quickest_change(p.kind, within)(from, to).distance();
            using quadrant::detail::shortest;
            const bool by_jerk = speed_profile::feasible(p.kind, free, length, from, to);
            refuse_line(p.line, quadrant::detail::rule(by_jerk ? "the jerk limit" : "the acceleration limit") +
                                    " cannot be met within the block: from " + shortest(from) + " to " +
                                    shortest(to) + " m/s needs " + shortest(needs) + " m of its " +
                                    shortest(length));
        }
        curve_ = speed_profile(p.kind, within, length, from, to);
    }

    /// The same move in a whole number of periods; throws when its speeds leave no room for that.
    profile in_whole_periods(quadrant::duration period) const {
        require_positive("profile.period", period);
        profile fitted = *this;
        const double whole = std::ceil(curve_.duration() / period.value() * (1 - 1e-12)) * period.value();
        if (!fitted.curve_.stretch(whole))
            refuse_line(given_.line, "the block cannot last " + quadrant::detail::shortest(whole) +
                                         " s, the next whole number of periods, with its speeds at both ends");
        return fitted;
    }

    motion operator()(quadrant::duration t) const noexcept { ///< t is held to the duration of the move
        const path_motion y = curve_.at(t.value());
        motion m;
        m.position = quantity_of<signal::position>::from_value(y.s);
        m.velocity = quantity_of<signal::velocity>::from_value(y.v);
        m.acceleration = quantity_of<signal::acceleration>::from_value(y.a);
        m.jerk = jerk::from_value(y.j);
        return m;
    }
    quadrant::duration lasts() const noexcept { return quadrant::duration::from_value(curve_.duration()); }
    const parameters& given() const noexcept { return given_; }

private:
    parameters given_;
    speed_profile curve_;
};

} // namespace quadrant::inline v0::trajectory
