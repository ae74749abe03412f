// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/select.hpp"
#include "../friction/already_checked.hpp"
#include "oscillator.hpp"

#include <cstddef>

namespace quadrant::inline v0 {

/// A second mass on a spring that rides on the axis and that the encoder does not see: anti-resonance at its
/// frequency (the axis held), resonance above it. It is part of the moving mass.
///   q'' + 2 zeta w q' + w^2 q = -dv/dt,   w = 2 pi centre,   momentum of the axis: M v + mass q'
/// The step is exact for an acceleration that is constant over it; that acceleration is solved together with
/// the axis: the axis sees M less what the spring takes of its own reaction (inertia()), and impulse() of what
/// rings already.
/// Source: [Altintas2012] chapter 3; derivation: docs/derivations/flexible_modes.md.
/// Ports: velocities of the axis before and after the step [m/s] into advance().
/// State: deflection q [m] and its speed w [m/s]; given and returned by the caller, as of `slip_contact`.
/// Range: 0 <= mass, below the axis' mass; centre > 0; 0 <= damping < 1. Runs in lanes; a mass of 0 is not
/// there. Throws "sprung_mass.<field> = ...: must ...".
/// Cost: 6 multiplications. Many modes in a reading: `flexible_modes`.
template <class Real = double> class sprung_mass {
public:
    using number = parameter_real<Real>; ///< of parameters

    /// The second mass and its spring.
    struct parameters {
        quantity<si::mass, number> mass{};                                                           ///< >= 0
        quantity<hertz_unit, number> centre = quantity<hertz_unit, number>::from_value(number(100)); ///< > 0
        number damping{0};                                                                           ///< zeta
    };
    /// Deflection against the axis [m] and its speed [m/s].
    struct state {
        Real q{0}, w{0};
    };

    sprung_mass(const parameters& p, Real h) : sprung_mass(checked(p), h, already_checked()) {}
    sprung_mass(const parameters& p, Real h, already_checked)
        : mass_(in_real<Real>(p.mass).value()), step_(in_real<Real>(p.centre).value(), Real(p.damping), h),
          inverse_step_(Real(1) / h), compliance_(Real(1) / step_.stiffness) {
        present_ = any(greater(mass_, Real(0)));
    }

    /// False when it is not there in any lane: then nothing of it needs to be asked.
    bool present() const noexcept { return present_; }
    /// To be added to the axis' mass: what accelerates at once with it and what does not.
    Real inertia() const noexcept { return mass_ * compliance_ * step_.back * inverse_step_; }
    /// To be taken from the momentum of the axis for this step [N s].
    Real impulse(const state& s) const noexcept {
        return mass_ * (step_.back * s.q + (step_.keep - Real(1)) * s.w);
    }
    void advance(state& s, Real before, Real after) const noexcept {
        const Real rest = (before - after) * inverse_step_ * compliance_, q = s.q - rest;
        s.q = rest + step_.stay * q + step_.onward * s.w;
        s.w = step_.back * q + step_.keep * s.w;
    }

private:
    static const parameters& checked(const parameters& p) {
        require_not_negative<Real>("sprung_mass.mass", p.mass);
        require_positive<Real>("sprung_mass.centre", p.centre);
        for (std::size_t i = 0; i < lane_count<Real>; ++i) {
            const double zeta = detail::plain(lane(p.damping, i));
            require(zeta >= 0 && zeta < 1, "sprung_mass.damping", zeta,
                    "must not be below 0 and must be below 1");
        }
        return p;
    }

    Real mass_;
    detail::oscillator<Real> step_;
    Real inverse_step_, compliance_;
    bool present_ = false;
};

} // namespace quadrant::inline v0
