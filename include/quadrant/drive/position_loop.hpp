// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "velocity_loop.hpp"

namespace quadrant::inline v0 {

/// The position loop inside a drive (cyclic synchronous position): P on position over a `velocity_loop`.
///   v_asked = gain (r - x) + velocity_feedforward r'
///   F       = velocity_loop(v_asked, v)
/// Source: docs/formats.md, `drive.kind` `position`; [Franklin1998] ch. 4 for the cascade.
/// Ports: loop(state, set-point, its velocity, position, velocity) once a step h of the drive; force out [N] or
/// [N m]. The set-point is that of a `set_point_line`.
/// State: that of the velocity loop.
/// Range: bare SI numbers; gain >= 0 [1/s]; velocity_feedforward: a share, 1 = the whole velocity of the
/// set-points. NaN and infinities pass on. Runs in lanes.
/// Throws "position_loop.<field> = ...: must ...", and in the name of `velocity_loop`.
/// Cost: 2 multiplications and the velocity loop. The cascade of a controller, in typed quantities: `p_pi`.
template <class Real = double> class position_loop {
public:
    using number = parameter_real<Real>; ///< of parameters

    /// Gains of both loops.
    struct parameters {
        number gain{0};                 ///< [1/s]; >= 0
        number velocity_feedforward{0}; ///< share of the set-points' velocity
        typename velocity_loop<Real>::parameters velocity{};
    };
    using state = typename velocity_loop<Real>::state; ///< of the velocity loop

    position_loop(const parameters& p, Real h) : position_loop(checked(p, h), h, already_checked()) {
        (void)velocity_loop<Real>(p.velocity, h);
    }
    position_loop(const parameters& p, Real h, already_checked) noexcept
        : gain_(p.gain), feedforward_(p.velocity_feedforward), velocity_(p.velocity, h, already_checked()) {}

    Real operator()(state& s, Real set_point, Real its_velocity, Real position, Real velocity) const noexcept {
        return velocity_(s, gain_ * (set_point - position) + feedforward_ * its_velocity, velocity);
    }

private:
    static const parameters& checked(const parameters& p, Real h) {
        require_positive<Real>("position_loop.step", h);
        require_not_negative<Real>("position_loop.gain", p.gain);
        require_finite<Real>("position_loop.velocity_feedforward", p.velocity_feedforward);
        return p;
    }

    Real gain_, feedforward_;
    velocity_loop<Real> velocity_;
};

} // namespace quadrant::inline v0
