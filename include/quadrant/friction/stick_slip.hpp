// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../signal.hpp"

#include <concepts>

namespace quadrant {

/// A friction law that a plant can take: what holds a resting axis, what brakes a moving one, its viscous slope.
/// slip(v) is even, does not exceed breakaway() and does not rise with the speed; what rises with it is viscous.
template <class F, class Real>
concept friction_law = requires(const F& f, quantity_of<signal::velocity, Real> v) {
    { f.breakaway() } -> std::convertible_to<quantity_of<signal::force, Real>>;
    { f.slip(v) } -> std::convertible_to<quantity_of<signal::force, Real>>;
    { f.viscous() } -> std::convertible_to<gain_of<signal::force, signal::velocity, Real>>;
};

/// Velocity v' after one step h of M dv/dt = drive - viscous v - dry friction, friction taken implicitly:
///   M (v' - v)/h = drive - viscous v' - f,   f = slip(v') sign(v'), or |f| <= breakaway when v' = 0
/// The implicit form makes stick exact (a resting axis below breakaway does not creep), does not chatter at any h and
/// adds no energy; sign(v) of the textbook form does the opposite of all three ([Armstrong1994] section 4).
/// Where the law falls so steeply that several v' solve it, an axis in motion takes the fastest: it goes on.
/// Derivation: docs/derivations/stick_slip.md.
template <class Real, friction_law<Real> Friction>
quantity_of<signal::velocity, Real>
stick_slip(const Friction& friction, quantity<si::mass, Real> mass, quantity_of<signal::velocity, Real> v,
           quantity_of<signal::force, Real> drive, quantity<si::time, Real> h) noexcept {
    using velocity = quantity_of<signal::velocity, Real>;
    using force = quantity_of<signal::force, Real>;
    const force push = force(mass * v / h) + drive; // what would bring the axis to rest within h, and the drive
    const gain_of<signal::force, signal::velocity, Real> slope = mass / h + friction.viscous();
    const bool forward = push > force();
    const force size = forward ? push : -push;

    // slope v' + slip(v') = size from above: each pass is slower, none slower than the fastest solution. A machine
    // axis needs 2 to 5 passes; more only where two solutions are about to vanish.
    constexpr int most_passes = 32;
    force dry = friction.slip(size / slope);
    for (int pass = 0; pass < most_passes && size > dry; ++pass) {
        const force next = friction.slip((size - dry) / slope);
        const bool nearer = next > dry;
        dry = next;
        if (!nearer) break;
    }
    // From rest, or through it to the other side: first break away. An axis that goes on needs more than slip.
    const bool goes_on = forward ? v > velocity() : v < velocity();
    if (size <= dry || (!goes_on && size <= friction.breakaway())) return velocity();
    return forward ? (size - dry) / slope : -((size - dry) / slope);
}

} // namespace quadrant
