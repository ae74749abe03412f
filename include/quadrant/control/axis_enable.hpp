// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <cmath>
#include <complex>
#include <cstddef>

namespace quadrant::inline v0 {

/// What an axis is doing. Its drive has power while `on` and while `stopping`.
enum class power_state : unsigned char { off, on, stopping, tripped };

/// What is asked of an axis in a sample: levels, not edges.
struct power_request {
    bool enable = false;
    bool emergency_stop = false; ///< ramp down, then off
    bool trip = false;           ///< off at once: following error, fault of the loop, of the drive
};

/// Switches an axis on and off, stops it in an emergency, and gives the loop the reference that belongs to
/// that.
///   off --enable rises--> on --enable falls--> stopping (deceleration) --at rest, brake closed--> off
///   on, stopping --emergency stop--> stopping (emergency_deceleration);   any --trip--> tripped --enable falls--> off
///   stopping: v = max(0, |v| - a T), x += T (v + v_before)/2: the path is v^2/(2 a) exactly; the stream is no longer heard
/// How a loop goes with it, so that each of its boxes is in a defined state (table in docs/integrator.md):
///   const auto r = power({.enable = button, .emergency_stop = mushroom, .trip = guard.tripped()}, stream);
///   if (power.on()) u = axis(r, measured); else axis.track(r, measured, u = applied);   // applied: 0, or another's output
/// Source: IEC 60204-1, 9.2.2: stop categories 0 (trip), 1 (emergency stop, disable).
/// Ports: requests and the stream's reference in, the reference of the loop out; on() says that the command
/// goes out.
/// An enable counts when it rises: after a stop it has to be taken away and given again. An emergency stop that
/// ends starts nothing. The stream has to wait where the axis is; a `following_error` reports it if it does
/// not.
/// State: last reference and its speed; `reset`: off, at zero; `settle(x)`: off, the stream at rest at x.
/// `shift(by)`: the frame of positions moves (homing).
/// Range: velocity and both decelerations finite, above 0: no stop is longer than velocity^2/(2 a), whatever
/// the stream did; brake_time >= 0: how long the loop holds the axis at rest until the brake has closed.
/// NaN and infinities: holds the last reference, raises faulted(), does not switch on; stops and trips are
/// obeyed all the same. Throws "axis_enable.<field> = ...: must ..." for period, velocity, deceleration,
/// emergency_deceleration, brake_time.
/// Cost: a dozen comparisons. The stop has no jerk limit: put a `stream_limiter` behind it, or leave the jump
/// to the notch.
template <class Real = double> class axis_enable {
public:
    using input = signal::position;
    using output = signal::position;
    using argument = quantity_of<signal::position, Real>;
    using value = argument;
    using velocity = quantity_of<signal::velocity, Real>;
    using acceleration = quantity_of<signal::acceleration, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// How fast the stream may be, how hard a stop brakes, and how long a brake takes to close.
    struct parameters {
        quantity<si::velocity, number> velocity; ///< of the stream at most, > 0: a stop begins with no more
        quantity<si::acceleration, number> deceleration;           ///< > 0, when enable falls
        quantity<si::acceleration, number> emergency_deceleration; ///< > 0
        duration brake_time{};                                     ///< >= 0
    };
    /// Off, on, stopping or tripped; where the reference is and how fast; the requests of the last sample, to
    /// see them rise.
    struct state {
        power_state power = power_state::off;
        value reference{};      ///< last output
        velocity speed{};       ///< of it
        std::size_t brake = 0;  ///< samples left until it has closed
        bool enable = false;    ///< as last asked
        bool emergency = false; ///< this stop is one
    };

    axis_enable(const parameters& p, duration period)
        : given_(p), period_(in_real<Real>(period)), fastest_(in_real<Real>(p.velocity)),
          gentle_(in_real<Real>(p.deceleration)), hard_(in_real<Real>(p.emergency_deceleration)) {
        require_positive<Real>("axis_enable.period", period);
        require_positive<Real>("axis_enable.velocity", p.velocity);
        require_positive<Real>("axis_enable.deceleration", p.deceleration);
        require_positive<Real>("axis_enable.emergency_deceleration", p.emergency_deceleration);
        require_not_negative<Real>("axis_enable.brake_time", p.brake_time);
        brake_ = std::size_t(std::ceil(p.brake_time.value() / period.value() * (1 - 1e-12)));
    }

    value operator()(const power_request& r, argument stream) noexcept {
        const velocity speed = (stream - state_.reference) / period_;
        const bool good = finite(stream, speed);
        if (!good) out_.raise();
        switch_over(r, good);
        if (state_.power == power_state::stopping)
            ramp();
        else if (good) {
            state_.reference = stream;
            state_.speed = speed;
        }
        return out_.keep(state_.reference);
    }
    void reset() noexcept { settle(argument()); }
    void settle(argument x) noexcept {
        if (!finite(x)) return out_.raise();
        state_ = {};
        state_.reference = x;
        out_.reset(x);
    }
    void shift(argument by) noexcept {
        if (!finite(by)) return out_.raise();
        state_.reference += by;
        out_.keep(state_.reference);
    }

    bool on() const noexcept { ///< the loop runs and its command goes to the drive
        return state_.power == power_state::on || state_.power == power_state::stopping;
    }
    power_state power() const noexcept { return state_.power; }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    void switch_over(const power_request& r, bool good) noexcept {
        using enum power_state;
        if (r.trip)
            state_.power = tripped;
        else if ((state_.power == tripped && !r.enable) ||
                 (state_.power == stopping && state_.speed == velocity() && state_.brake-- == 0))
            state_.power = off;
        else if (state_.power == off && r.enable && !state_.enable && !r.emergency_stop && good)
            state_.power = on;
        else if (state_.power == on && (r.emergency_stop || !r.enable)) {
            state_.power = stopping;
            const velocity v = state_.speed;
            state_.speed = v > fastest_    ? fastest_
                           : v < -fastest_ ? -fastest_
                                           : v; // the stream may have jumped
            state_.brake = brake_;
            state_.emergency = false;
        }
        if (r.emergency_stop) state_.emergency = true;
        if (good || !r.enable) state_.enable = r.enable;
    }
    void ramp() noexcept {
        const acceleration a = state_.emergency ? hard_ : gentle_;
        const velocity less = a * period_, v = state_.speed, speed = v < velocity() ? -v : v;
        if (speed > less) {
            state_.speed = v < velocity() ? v + less : v - less;
            state_.reference += Real(0.5) * ((v + state_.speed) * period_);
        } else { // comes to rest within this period
            state_.reference += Real(0.5) * (v * (speed / a));
            state_.speed = velocity();
        }
    }

    parameters given_;
    quantity<si::time, Real> period_;
    velocity fastest_;
    acceleration gentle_, hard_;
    std::size_t brake_ = 0;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
