// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "look_ahead.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

namespace quadrant::inline v0::trajectory {

/// What a path asks of the three axes at one moment.
struct path_reference {
    std::array<motion, 3> axis; ///< x, y, z
    double speed = 0;           ///< magnitude of the velocity [m/s]
    std::size_t line = 0;       ///< of the program, where it is now
    bool resting = true;        ///< at a stop, in a dwell, or without a path
};

/// A path in, a reference for every axis in every servo period out.
///   while (!drive.full() && moves are left) drive.push(next move);   axes(drive());
/// Position, velocity, acceleration and jerk are those of one continuous motion r(s(t)) (two pieces at once in
/// a corner), so that between samples too every axis stays within its limits, and |r'|, |s''|, |s'''| within
/// those of the path.
/// At every stop the motion ends on a servo period, exactly at the end of the piece: the last piece before it
/// is driven a little slower (less than one period longer). Dwells last whole periods, rounded up.
/// Source: [Yeung2006] (trajectory generation, interpolation per control interval), [ErkorkmazAltintas2001]
/// (profiles, refitted times), [Tajima2016] (corners). Equations: docs/trajectory.md.
/// Ports: moves by `push`, when there is room; one path_reference a call. No input can be NaN: segments are
/// finite.
/// State: the window of moves, the piece under way, the time into it; `settle(place)` forgets all and stands
/// there; the next move may then start anywhere. Where moves come too late it stops at the end of what it
/// knows, within all limits.
/// Range: limits above 0, infinite = none; those that the profile cannot keep must be infinite.
/// Throws "interpolator.path.jerk = ...: must ..."; `push`: "line = 12: ..." for what cannot be driven, and
/// changes nothing.
/// Cost: a call allocates nothing, and looks at no more pieces than it passes (at most Window); some 100 kB
/// with Window 128.
/// One thread: `push` between calls. For one axis from rest to rest without a path: `profile`.
template <std::size_t Window = 128> class interpolator {
public:
    /// What path and axes bear, and how the speed changes.
    struct parameters {
        machine_limits limits;
        profile_kind kind = profile_kind::trapezoidal_acceleration;
    };

    interpolator(const parameters& p, quadrant::duration period)
        : given_(p), period_(period.value()), ahead_(p.limits, p.kind, checked(p, period)) {}

    bool full() const noexcept { return ahead_.full(); } ///< no room for another move
    /// Adds a move behind those known; needs !full().
    void push(const path::move& next) {
        require(!full(), "interpolator.push", double(Window), "must wait: the window is full");
        ahead_.push(next);
        if (!settled_) stand_at(next.path.start(), next.line);
    }

    /// One servo period on.
    const path_reference& operator()() noexcept {
        if (!under_way_ && !start()) return now_;
        t_ += period_;
        const double hair = 1e-6 * period_;
        for (;;) {
            const double lasts = in_corner_ ? leaving_.duration : course_.body.duration();
            if (t_ < lasts - hair) break;
            if (!in_corner_ && !(course_.out > 0)) {
                stop();
                return now_;
            }
            t_ = std::max(0.0, t_ - lasts);
            in_corner_ ? next_piece() : enter_corner();
        }
        in_corner_ ? through_corner() : along_piece();
        return now_;
    }
    const path_reference& now() const noexcept { return now_; }
    /// Everything that is known has been driven, and every dwell is over.
    bool done() const noexcept { return !under_way_ && ahead_.pieces() == 0 && dwell_ == 0; }
    void reset() noexcept {
        settle({});
        settled_ = false;
    }
    void settle(path::point place) noexcept {
        ahead_.clear();
        under_way_ = in_corner_ = false;
        dwell_ = 0;
        stand_at(place, 0);
    }
    const parameters& given() const noexcept { return given_; }

private:
    static quadrant::duration checked(const parameters& p, quadrant::duration period) {
        require_positive("interpolator.period", period);
        require_limits("interpolator.path", p.limits.path, p.kind);
        require_limits("interpolator.x", p.limits.axis[0], p.kind);
        require_limits("interpolator.y", p.limits.axis[1], p.kind);
        require_limits("interpolator.z", p.limits.axis[2], p.kind);
        return period;
    }
    std::size_t periods(double time) const noexcept {
        return time > 0 ? std::size_t(std::ceil(time / period_ - 1e-6)) : 0;
    }

    /// From rest; false while there is nothing to drive or a dwell lasts.
    bool start() noexcept {
        if (ahead_.pieces() > 0 && dwell_ == 0 && !waited_) dwell_ = periods(ahead_.front().dwell_before);
        waited_ = ahead_.pieces() > 0;
        if (dwell_ > 0) return --dwell_, false;
        if (ahead_.pieces() == 0) return false;
        under_way_ = true;
        t_ = 0;
        begin(0);
        return true;
    }
    void begin(double in) noexcept {
        in_corner_ = false;
        course_ = ahead_.begin(in);
        if (course_.out > 0) return;
        const double left = course_.body.duration() - t_;
        course_.body.stretch(t_ + std::ceil(left / period_ - 1e-9) * period_); // ends on a period
    }
    void enter_corner() noexcept {
        in_corner_ = true;
        leaving_ = ahead_.joint_ahead().falling(course_.out);
        reaching_ = ahead_.joint_ahead().rising(course_.out);
    }
    void next_piece() noexcept {
        ahead_.pop();
        begin(course_.out);
    }
    void stop() noexcept {
        const auto end = ahead_.on_front(ahead_.front().whole.length);
        stand_at(end.path->end(), end.line);
        dwell_ = periods(ahead_.front().dwell);
        under_way_ = waited_ = false;
        ahead_.pop();
    }

    void stand_at(path::point place, std::size_t line) noexcept {
        settled_ = true;
        now_ = {};
        now_.line = line;
        report(place, {}, {}, {});
    }
    void along_piece() noexcept {
        const path_motion y = course_.body.at(t_);
        const auto here = ahead_.on_front(y.s + course_.leg_in);
        const moved m = on(here, y);
        now_.line = here.line;
        now_.resting = false;
        report(m.r, m.v, m.a, m.j);
    }
    void through_corner() noexcept {
        const path_motion y1 = leaving_.at(t_), y2 = reaching_.at(t_);
        const auto from = ahead_.on_front(y1.s + ahead_.front().whole.length - course_.leg_out);
        const auto to = ahead_.on_second(y2.s);
        const moved m1 = on(from, y1), m2 = on(to, y2);
        now_.line = 2 * t_ < leaving_.duration ? from.line : to.line;
        now_.resting = false;
        report(m1.r + (m2.r - ahead_.on_second(0).path->start()), m1.v + m2.v, m1.a + m2.a, m1.j + m2.j);
    }
    struct moved {
        path::point r, v, a, j;
    };
    [[gnu::always_inline]] static moved on(const typename look_ahead<Window>::place& at,
                                           const path_motion& y) noexcept {
        const auto* straight = std::get_if<path::line>(&at.path->shape());
        if (!straight) return on_curve(at, y);
        const path::point t = straight->tangent(at.s);
        return {straight->position(at.s), y.v * t, y.a * t, y.j * t};
    }
    static moved on_curve(const typename look_ahead<Window>::place& at, const path_motion& y) noexcept {
        const path::segment& path = *at.path;
        const path::point t = path.tangent(at.s), k = path.curvature(at.s), d = third_derivative(path, at.s);
        return {path.position(at.s), y.v * t, y.a * t + y.v * y.v * k,
                y.j * t + 3 * y.v * y.a * k + y.v * y.v * y.v * d};
    }
    void report(path::point r, path::point v, path::point a, path::point j) noexcept {
        for (int i = 0; i < 3; ++i) {
            motion& m = now_.axis[std::size_t(i)];
            m.position = quantity_of<signal::position>::from_value(r[i]);
            m.velocity = quantity_of<signal::velocity>::from_value(v[i]);
            m.acceleration = quantity_of<signal::acceleration>::from_value(a[i]);
            m.jerk = jerk::from_value(j[i]);
        }
        now_.speed = magnitude(v);
    }

    parameters given_;
    double period_;
    look_ahead<Window> ahead_;
    typename look_ahead<Window>::course course_;
    speed_change leaving_, reaching_;
    double t_ = 0; ///< into the body or the corner [s]
    std::size_t dwell_ = 0;
    bool under_way_ = false, in_corner_ = false, settled_ = false, waited_ = false;
    path_reference now_;
};

} // namespace quadrant::inline v0::trajectory
