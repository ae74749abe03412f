// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/signal.hpp"

#include <concepts>
#include <type_traits>

namespace quadrant::inline v0 {

/// A friction law that a plant can take: what holds a resting axis, what brakes a moving one, its viscous
/// slope. slip(v) is even, does not exceed breakaway() and does not rise with the speed; what rises with it is
/// viscous.
template <class F, class Real>
concept friction_law = requires(const F& f, quantity_of<signal::velocity, Real> v) {
    { f.breakaway() } -> std::convertible_to<quantity_of<signal::force, Real>>;
    { f.slip(v) } -> std::convertible_to<quantity_of<signal::force, Real>>;
    { f.viscous() } -> std::convertible_to<gain_of<signal::force, signal::velocity, Real>>;
};

/// A law that also says how its level falls: slip(v) and its slope at v >= 0, and 1 over the speed over which
/// that changes e-fold. Newton's method may use them where slip is convex: convex() is false where it is not,
/// and the level is then iterated by itself.
template <class F, class Real>
concept friction_law_with_slope = friction_law<F, Real> &&
    requires(F& f, quantity_of<signal::velocity, Real> v) {
    { f.convex() } -> std::convertible_to<bool>;
    f.fall(v).level;
    f.fall(v).slope;
    f.fall(v).inverse_scale;
};

/// A law that knows directions, and whose level may rise with the speed as well: `asymmetric_stribeck`. Its
/// slip(v) is a magnitude, too; parts(forward, speed) are a part that falls with the speed and is convex, and
/// one that rises and is concave.
template <class F, class Real>
concept friction_law_by_direction = requires(const F& f, quantity_of<signal::velocity, Real> v, bool forward) {
    { f.breakaway(forward) } -> std::convertible_to<quantity_of<signal::force, Real>>;
    { f.slip(v) } -> std::convertible_to<quantity_of<signal::force, Real>>;
    { f.viscous() } -> std::convertible_to<gain_of<signal::force, signal::velocity, Real>>;
    f.parts(forward, v).falling;
    f.parts(forward, v).rising;
    f.parts(forward, v).falling_slope;
    f.parts(forward, v).rising_slope;
    f.parts(forward, v).steepest;
    f.parts(forward, v).scale;
};

/// What a plant steps in the sub-steps of one period: the law's own form for that, if it has one, or the law.
template <class Friction> decltype(auto) in_sub_steps(const Friction& law) noexcept {
    if constexpr (requires { law.in_sub_steps(); })
        return law.in_sub_steps();
    else
        return (law);
}

namespace detail {
/// Relative error that may be left to the velocity of a step.
template <class Real> inline constexpr double stick_slip_accuracy = 3e-14;
template <> inline constexpr double stick_slip_accuracy<float> = 1e-7;

/// The fastest v' >= 0 with slope v' + slip(v') = size by Newton's method, 0 when there is none; `start` > 0
/// from where. On a convex curve a tangent lies below it: its zero is not below a solution, wherever it touches
/// a rising part, and the next ones come down to the fastest. Half of what the tangent misses the curve by is
/// known from the curvature and taken off; ended by the error that is left then: in motion mostly after one
/// pass. Bare SI numbers inside: a choice between two quantities goes through memory. Each sub-step of a plant
/// waits for the one before it: a division that is rarely needed stands behind a branch.
template <class Real, class Friction>
[[gnu::always_inline]] inline quantity_of<signal::velocity, Real>
fastest_sliding(Friction& friction, const Real slope, const Real size, const Real start) noexcept {
    using velocity = quantity_of<signal::velocity, Real>;
    const Real close = Real(stick_slip_accuracy<Real>);
    const auto within = [&](const Real& x) { return slope * x < size; }; // below the speed without friction
    const auto held = [&](const Real& x) -> Real {
        if (within(x)) [[likely]]
            return x;
        return size / slope;
    };
    bool anywhere = within(start); // not known to lie above the solution
    Real v = held(start);
    constexpr int most_passes = 32;
    for (int pass = 0; pass < most_passes; ++pass) {
        const auto fall = friction.fall(velocity::from_value(v));
        const Real falls = -fall.slope.value(), rise = slope - falls;
        if (!(rise > Real(0))) { // left of the lowest point: where the axis was, or there is no solution
            if (!anywhere) return velocity();
            anywhere = false;
            v = size / slope;
            continue;
        }
        anywhere = false;
        const Real per_force = Real(1) / rise, step = (slope * v + fall.level.value() - size) * per_force;
        const Real next = v - step;
        if (!(next > Real(0))) return velocity();
        const Real way = step < Real(0) ? -step : step, scales = way * fall.inverse_scale.value();
        const Real curvature = falls * fall.inverse_scale.value(); // within a scale at most e times that
        const Real bent = curvature * (way * way);
        if (scales <= Real(1)) {
            if constexpr (std::floating_point<Real>) {
                if (falls <= rise && bent * scales <= close * (rise * next))
                    return velocity::from_value(
                        held(next - (way * way) * (curvature * (Real(0.5) * per_force))));
            } else if (bent <= close * (rise * next)) // the tangent's carries the derivatives
                return velocity::from_value(held(next));
        }
        v = held(next);
    }
    return velocity::from_value(v);
}

/// The fastest v' >= 0 with slope v' + slip(v') = size, where the level may rise: 0 when there is none. From
/// above, as stick_slip does: the falling part is convex, so that its tangent at a speed that is known to be too
/// fast leaves too much for the rest, whose speed is again too fast, and nearer. The rest is a concave equation:
/// Newton's method from below. The last pass is Newton's for the whole, once the curvature says that it is
/// exact.
template <class Real, class Friction>
quantity_of<signal::velocity, Real>
fastest_in_direction(const Friction& friction, const gain_of<signal::force, signal::velocity, Real>& slope,
                     const quantity_of<signal::force, Real>& size, bool forward) noexcept {
    using velocity = quantity_of<signal::velocity, Real>;
    using force = quantity_of<signal::force, Real>;
    using gain = gain_of<signal::force, signal::velocity, Real>;
    const Real close = Real(stick_slip_accuracy<Real>);
    velocity v = size / slope;
    constexpr int most_passes = 32;
    for (int pass = 0; pass < most_passes; ++pass) {
        auto at = friction.parts(forward, v);
        const gain rise = slope + at.falling_slope + at.rising_slope;
        const force above = slope * v + at.falling + at.rising - size;
        if (rise > gain()) {
            const velocity step = above / rise, next = v - step;
            const force left = at.steepest * (Real(step / at.scale) * step);
            if (next > velocity() && (left < force() ? -left : left) <= close * (rise * next)) return next;
        }
        const gain along = slope + at.falling_slope; // with the tangent of the falling part; may fall
        const force rest = size - at.falling + force(at.falling_slope * v); // for that and the rising part
        if (!(rest > force())) return velocity();
        if (!(rise > gain())) { // beyond the hump of the rest
            v = velocity();
            at = friction.parts(forward, v);
        }
        for (int inner = 0; inner < most_passes; ++inner) {
            const velocity step = (rest - along * v - at.rising) / (along + at.rising_slope);
            v += step;
            if (!(v > velocity())) v = velocity();
            if (inner > 0 && step <= close * v) break; // from below: what is left is smaller yet
            at = friction.parts(forward, v);
        }
        if (!(v > velocity())) return velocity();
    }
    return v;
}
} // namespace detail

/// Velocity v' after one step h of M dv/dt = drive - viscous v - dry friction, friction taken implicitly:
///   M (v' - v)/h = drive - viscous v' - f,   f = slip(v') sign(v'), or |f| <= breakaway when v' = 0
/// The implicit form makes stick exact (a resting axis below breakaway does not creep), does not chatter at any
/// h and adds no energy; sign(v) of the textbook form does the opposite of all three ([Armstrong1994] section
/// 4). Where the law falls so steeply that several v' solve it, an axis in motion takes the fastest: it goes
/// on. `friction`: the law, or for several steps in a row what `in_sub_steps(law)` gives.
/// Derivation: docs/derivations/stick_slip.md.
template <class Real, class Friction>
requires friction_law<std::remove_cvref_t<Friction>, Real>
[[gnu::always_inline]] inline quantity_of<signal::velocity, Real>
stick_slip(Friction&& friction, quantity<si::mass, Real> mass, quantity_of<signal::velocity, Real> v,
           quantity_of<signal::force, Real> drive, quantity<si::time, Real> h) noexcept {
    using velocity = quantity_of<signal::velocity, Real>;
    using force = quantity_of<signal::force, Real>;
    const gain_of<signal::force, signal::velocity, Real> inertia = mass / h; // a loop of sub-steps divides once
    const force push = force(inertia * v) + drive; // what would bring the axis to rest within h, and the drive
    const gain_of<signal::force, signal::velocity, Real> slope = inertia + friction.viscous();
    const bool forward = push > force();
    const force size = force::from_value(forward ? push.value() : -push.value());

    if constexpr (friction_law_with_slope<std::remove_reference_t<Friction>, Real>)
        if (friction.convex()) { // from where the axis is: a step does not change it much
            const Real along = forward ? v.value() : -v.value(), most = size.value();
            const bool goes_on = along > Real(0);
            if (!goes_on && most <= friction.breakaway().value()) return velocity();
            Real start{};
            if (!goes_on)
                start = most / slope.value();
            else if constexpr (requires { friction.foreseen(v); })
                start = friction.foreseen(velocity::from_value(along)).value();
            else
                start = along;
            const Real next = detail::fastest_sliding<Real>(friction, slope.value(), most, start).value();
            return velocity::from_value(forward ? next : -next);
        }
    // slope v' + slip(v') = size from above: each pass is slower, none slower than the fastest solution. A
    // machine axis needs 2 to 5 passes; more only where two solutions are about to vanish.
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

/// The same on a law that knows directions: breakaway and level of the direction in which the axis is pushed.
template <class Real, friction_law_by_direction<Real> Friction>
requires(!friction_law<Friction, Real>) quantity_of<signal::velocity, Real> stick_slip(
    const Friction& friction, quantity<si::mass, Real> mass, quantity_of<signal::velocity, Real> v,
    quantity_of<signal::force, Real> drive, quantity<si::time, Real> h)
noexcept {
    using velocity = quantity_of<signal::velocity, Real>;
    using force = quantity_of<signal::force, Real>;
    const force push = force(mass * v / h) + drive;
    const bool forward = push > force(), goes_on = forward ? v > velocity() : v < velocity();
    const force size = forward ? push : -push;
    if (!goes_on && size <= friction.breakaway(forward)) return velocity();
    const velocity speed =
        detail::fastest_in_direction<Real>(friction, mass / h + friction.viscous(), size, forward);
    return forward ? speed : -speed;
}

} // namespace quadrant::inline v0
