// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/select.hpp"
#include "../friction/already_checked.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace quadrant::inline v0 {

/// A hobby or robot servo: a proportional law that turns a position error into the duty of a PWM bridge.
///   f' = r, at most `rate` a second           the servo's own profile
///   d  = gain (f - q) + minimum sign(f - q),  |d| <= maximum
/// The motor's voltage is d times the supply, its torque that times the torque constant; back-EMF is part of
/// the viscous friction.
/// Source: docs/formats.md, `drive.kind` `position_servo`; [Duclusaud2025] for such a servo's law.
/// Ports: servo(state, set-point, position) once a step h; duty out (-1 ... 1).
/// State: the set-point that is followed, given and returned by the caller; `state::at(q)`: at rest there.
/// Range: bare SI numbers; gain > 0 [1/rad]; 0 <= minimum; 0 < maximum; rate > 0 [rad/s], infinite: none.
/// NaN and infinities pass on. Runs in lanes.
/// Throws "position_servo.<field> = ...: must ...".
/// Cost: 2 multiplications. A drive with loops of its own for velocity and position: `position_loop`.
template <class Real = double> class position_servo {
public:
    using number = parameter_real<Real>; ///< of parameters

    /// Law of the servo and its bounds.
    struct parameters {
        number gain{1};    ///< duty a [rad] or [m]; > 0
        number minimum{0}; ///< duty added in the direction of the error; >= 0
        number maximum{1}; ///< of the duty; > 0
        number rate{std::numeric_limits<double>::infinity()}; ///< at most, of the set-point that is followed
    };
    /// The set-point that is followed.
    struct state {
        Real followed{0};

        static state at(Real position) noexcept { return {position}; }
    };

    position_servo(const parameters& p, Real h) : position_servo(checked(p, h), h, already_checked()) {}
    position_servo(const parameters& p, Real h, already_checked) noexcept
        : gain_(p.gain), minimum_(p.minimum), maximum_(p.maximum), step_(h * Real(p.rate)) {}

    /// A step in which no duty is asked for.
    void follow(state& s, Real set_point) const noexcept {
        s.followed = limited_to(set_point, s.followed - step_, s.followed + step_);
    }
    Real operator()(state& s, Real set_point, Real position) const noexcept {
        follow(s, set_point);
        const Real e = s.followed - position, none(0);
        const Real least = select(greater(e, none), minimum_, select(less(e, none), -minimum_, none));
        return limited_to(gain_ * e + least, maximum_);
    }

private:
    static const parameters& checked(const parameters& p, Real h) {
        require_positive<Real>("position_servo.step", h);
        require_positive<Real>("position_servo.gain", p.gain);
        require_not_negative<Real>("position_servo.minimum", p.minimum);
        for (std::size_t i = 0; i < lane_count<Real>; ++i) {
            require(lane(p.maximum, i) > 0, "position_servo.maximum", lane(p.maximum, i), "must be above 0");
            require(lane(p.rate, i) > 0, "position_servo.rate", lane(p.rate, i),
                    "must be above 0 (infinite: no limit)");
        }
        return p;
    }

    Real gain_, minimum_, maximum_, step_;
};

} // namespace quadrant::inline v0
