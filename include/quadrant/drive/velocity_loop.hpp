// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/select.hpp"
#include "../friction/already_checked.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace quadrant::inline v0 {

/// The velocity loop inside a drive: what turns an asked velocity into the force of the motor, on the drive's
/// own clock.
///   w' = 2 pi filter (v - w)                       velocity filter, exact over the step; none: w = v
///   e  = asked - w                                 mean over the step
///   I' = integral e,  |I| <= limit
///   F  = gain e + I,  |F| <= limit                 mean over the step: I as in its middle
/// Source: docs/formats.md, `drive.kind` `velocity`; [Franklin1998] ch. 4 for P and PI.
/// Ports: loop(state, asked, velocity) once a step h: asked and measured velocity of the motor in [m/s] or
/// [rad/s], force out [N] or [N m].
/// State: integral [N] and filtered velocity, given and returned by the caller; `state::at(v)`: in steady
/// motion at v.
/// Range: bare SI numbers, because a fit moves each of them; gain, integral >= 0; filter > 0, infinite: none;
/// limit > 0, infinite: none.
/// NaN and infinities pass on. Runs in lanes.
/// Throws "velocity_loop.<field> = ...: must ...".
/// Cost: 4 multiplications. The same on the controller's clock, in typed quantities: `proportional_integral`.
template <class Real = double> class velocity_loop {
public:
    using number = parameter_real<Real>; ///< of parameters

    /// Gains, filter and limit of the loop.
    struct parameters {
        number gain{0};                                            ///< [N s/m]; >= 0
        number integral{0};                                        ///< [N/m]; >= 0; 0: a P loop
        number filter_Hz{std::numeric_limits<double>::infinity()}; ///< corner of the filter of the velocity
        number limit{std::numeric_limits<double>::infinity()};     ///< of the force [N]
    };
    /// What the loop remembers.
    struct state {
        Real integral{0}, filtered{0};

        static state at(Real velocity, Real force = Real(0)) noexcept { return {force, velocity}; }
    };

    velocity_loop(const parameters& p, Real h) : velocity_loop(checked(p, h), h, already_checked()) {}
    velocity_loop(const parameters& p, Real h, already_checked) noexcept
        : gain_(p.gain), half_integral_(Real(0.5) * h * Real(p.integral)), limit_(p.limit) {
        using std::exp;
        const Real turns = Real(2 * std::numbers::pi) * h * Real(p.filter_Hz);
        follow_ = Real(1) - exp(-turns);
        behind_ = follow_ / turns;
    }

    Real operator()(state& s, Real asked, Real velocity) const noexcept {
        const Real ahead = velocity - s.filtered;
        const Real e = asked - velocity + behind_ * ahead;
        s.filtered = s.filtered + follow_ * ahead;
        const Real half = half_integral_ * e, in_the_middle = s.integral + half;
        s.integral = limited_to(in_the_middle + half, limit_);
        return limited_to(gain_ * e + in_the_middle, limit_);
    }

private:
    static const parameters& checked(const parameters& p, Real h) {
        require_positive<Real>("velocity_loop.step", h);
        require_not_negative<Real>("velocity_loop.gain", p.gain);
        require_not_negative<Real>("velocity_loop.integral", p.integral);
        for (std::size_t i = 0; i < lane_count<Real>; ++i) {
            require(lane(p.filter_Hz, i) > 0, "velocity_loop.filter_Hz", lane(p.filter_Hz, i),
                    "must be above 0 (infinite: no filter)");
            require(lane(p.limit, i) > 0, "velocity_loop.limit", lane(p.limit, i),
                    "must be above 0 (infinite: no limit)");
        }
        return p;
    }

    Real gain_, half_integral_, limit_;
    Real follow_{1}, behind_{0}; ///< of what it is ahead: taken over in a step, and missing on average
};

} // namespace quadrant::inline v0
