// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/select.hpp"
#include "../friction/already_checked.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace quadrant::inline v0 {

/// Play between a motor and a load that both have mass and friction. On a flank they are one body; they part
/// where the motor alone would fall behind the load (it brakes and the load coasts on, or it turns round and
/// the load's friction holds it), and meet again without a rebound.
///   apart:  m v' = push - F_motor,  (M - m) w' = pull - (F - F_motor) - viscous w
///   meet:   M v = m v + (M - m) w
/// Friction is implicit and stops a body, never turns it: no step adds energy.
/// Source: [Nordin2002] (two inertias and a dead zone), for a stiff shaft and a contact without rebound.
/// Ports: part() takes the velocity of the one body, forces on motor and load [N] and the level of the friction
/// [N]; meet() moves both.
/// State: position and velocity of the load, and the flank (-1, 0, 1); given and returned by the caller, as of
/// `slip_contact`.
/// Range: width >= 0; 0 < motor_mass; from the whole mass on there is nothing to part. Runs in lanes.
/// Throws "play_between_masses.<field> = ...: must ...".
/// Cost: 14 multiplications. A load without mass, held by its friction: `backlash`.
template <class Real = double> class play_between_masses {
public:
    using number = parameter_real<Real>; ///< of parameters
    using mask = mask_of<Real>;

    /// Width of the play, and what of mass and friction is on the motor's side.
    struct parameters {
        number width{0};                                             ///< from flank to flank [m]; >= 0
        number mass{1};                                              ///< of both [kg]; > 0
        number motor_mass{std::numeric_limits<double>::infinity()};  ///< of the motor [kg]; > 0
        number motor_level{std::numeric_limits<double>::infinity()}; ///< of its friction at most [N]; >= 0
        number viscous{0};                                           ///< on the load [N s/m]; >= 0
    };
    /// Position [m] and velocity [m/s] of the load, and the flank on which it is.
    struct state {
        Real load{0}, w{0}, flank{0};
    };

    play_between_masses(const parameters& p, Real h) : play_between_masses(checked(p), h, already_checked()) {}
    play_between_masses(const parameters& p, Real h, already_checked)
        : h_(h), half_(Real(0.5) * h), half_width_(Real(0.5) * Real(p.width)), level_(p.motor_level) {
        const Real mass(p.mass), given(p.motor_mass);
        present_ = both(greater(half_width_, Real(0)), less(given, mass));
        motor_mass_ = select(present_, given, Real(0.5) * mass);
        load_mass_ = mass - motor_mass_;
        share_ = motor_mass_ / mass;
        inverse_motor_ = Real(1) / motor_mass_;
        inverse_load_ = Real(1) / (load_mass_ + h * Real(p.viscous));
    }

    /// In which lanes there is one.
    const mask& present() const noexcept { return present_; }

    /// `v`: of the one body at the end of the step, then of the motor; `before`: of the motor at its start.
    /// Says where the two are apart.
    mask part(state& s, Real before, Real& v, Real push, Real pull, Real level) const noexcept {
        const Real on_motor = select(less(level, level_), level, level_);
        const Real motor = slowed(motor_mass_ * before + h_ * push, h_ * on_motor) * inverse_motor_;
        const Real load = slowed(load_mass_ * s.w + h_ * pull, h_ * (level - on_motor)) * inverse_load_;
        const auto together = both(!equal(s.flank, Real(0)), greater_equal(s.flank * (motor - load), Real(0)));
        const auto apart = both(present_, !together);
        v = select(apart, motor, v);
        const Real w = select(apart, load, v);
        s.load = s.load + half_ * (s.w + w);
        s.w = w;
        s.flank = select(apart, Real(0), s.flank);
        return apart;
    }
    /// Both after the step: they stay apart by half the width at most.
    void meet(state& s, Real& x, Real& v) const noexcept {
        using std::abs;
        const Real gap = x - s.load;
        const auto meets = both(present_, both(equal(s.flank, Real(0)), greater_equal(abs(gap), half_width_)));
        const Real flank = select(greater(gap, Real(0)), Real(1), Real(-1));
        const Real beyond = gap - flank * half_width_;
        x = select(meets, x - (Real(1) - share_) * beyond, x);
        v = select(meets, share_ * v + (Real(1) - share_) * s.w, v);
        s.w = select(meets, v, s.w);
        s.flank = select(meets, flank, s.flank);
        s.load = select(equal(s.flank, Real(0)), s.load, x - s.flank * half_width_);
    }

private:
    static const parameters& checked(const parameters& p) {
        require_not_negative<Real>("play_between_masses.width", p.width);
        require_positive<Real>("play_between_masses.mass", p.mass);
        require_not_negative<Real>("play_between_masses.viscous", p.viscous);
        for (std::size_t i = 0; i < lane_count<Real>; ++i) {
            require(lane(p.motor_mass, i) > 0, "play_between_masses.motor_mass", lane(p.motor_mass, i),
                    "must be above 0");
            require(lane(p.motor_level, i) >= 0, "play_between_masses.motor_level", lane(p.motor_level, i),
                    "must not be below 0");
        }
        return p;
    }
    /// A momentum that friction takes from.
    static Real slowed(Real momentum, Real by) noexcept {
        const Real left = select(greater(momentum, Real(0)), momentum - by, -momentum - by);
        const Real kept = select(less_equal(left, Real(0)), Real(0), left);
        return select(greater(momentum, Real(0)), kept, -kept);
    }

    Real h_, half_, half_width_, level_, motor_mass_{}, load_mass_{}, share_{}, inverse_motor_{},
        inverse_load_{};
    mask present_{};
};

} // namespace quadrant::inline v0
