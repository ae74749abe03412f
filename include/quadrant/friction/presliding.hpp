// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/standstill.hpp"
#include "stribeck.hpp"

#include <cmath>
#include <concepts>

namespace quadrant::inline v0 {

namespace detail {
/// How near to the solution Newton's method is before its last pass, which then is exact to rounding.
template <class Real> inline constexpr double newton_accuracy = 2e-14;
template <> inline constexpr double newton_accuracy<float> = 3e-7;

/// d slip/d|v| of a Stribeck curve that has the level slip(v) at v, never above zero; at rest, where an
/// exponent below one is infinitely steep, as for one.
template <signal_tag In, signal_tag Out, class Real>
gain_of<Out, In, Real> slip_slope(const stribeck<In, Out, Real>& curve, quantity_of<In, Real> v,
                                  quantity_of<Out, Real> level) noexcept {
    using std::abs, std::exp, std::log;
    const auto& given = curve.given();
    const Real delta = Real(given.shape);
    const quantity_of<In, Real> scale = in_real<Real>(given.stribeck_velocity);
    const quantity_of<Out, Real> excess = level - in_real<Real>(given.coulomb);
    if (given.shape == 1) return -(excess / scale);
    const Real ratio = abs((v / scale).value());
    if (ratio == Real(0)) return given.shape > 1 ? gain_of<Out, In, Real>() : -(excess / scale);
    return -(excess / scale) * (delta * exp((delta - Real(1)) * log(ratio)));
}
} // namespace detail

/// What a law with a memory answers to "and if the axis moved at v for h?"
template <signal_tag In, signal_tag Out, class State, class Real> struct friction_outcome {
    quantity_of<Out, Real> force{}; ///< at the end of the step, viscous part included
    gain_of<Out, In, Real> slope{}; ///< of that force by v
    State next{};                   ///< the memory then
};

namespace detail {
/// A held force, limited to `most` in either direction.
template <class Value> Value borne(const Value& force, const Value& most) noexcept {
    return force > most ? most : force < -most ? -most : force;
}
/// Memory and last good output of a block that is a law with a memory; an outcome is taken over when it is
/// finite.
template <class Outcome, class Argument> class friction_memory {
    using value = decltype(Outcome::force);
    using state = decltype(Outcome::next);

public:
    value step(Argument v, const Outcome& to) noexcept {
        return step(v, to.force, [&](state& memory) { memory = to.next; });
    }
    value step(Argument v, value force, auto&& move) noexcept {
        if (!finite(v, force)) return out_.hold();
        move(state_);
        return out_.keep(force);
    }
    void settle(Argument v, value force, const state& at) noexcept {
        if (!finite(v, force)) return out_.raise();
        state_ = at;
        out_.reset(force);
    }
    void reset() noexcept {
        state_ = {};
        out_.reset();
    }
    void become(const state& next) noexcept { state_ = next; }
    void raise() noexcept { out_.raise(); }
    const state& now() const noexcept { return state_; }
    bool faulted() const noexcept { return out_.faulted(); }

private:
    state state_;
    held_output<value> out_;
};
} // namespace detail

/// A friction law that remembers where the axis came from: bristles, or elements that stick and slip. after(v,
/// h) asks and changes nothing, become(next) lets it happen. The force at v = 0 is that of the memory; it does
/// not fall with v faster than the inertia of the axis resists (mass / h).
/// Velocity to force, or, of a rotary axis, angular velocity to torque.
template <class F, class Real, class In = signal::velocity, class Out = signal::force>
concept friction_with_memory = requires(F& changed, const F& f, quantity_of<In, Real> v,
                                        quantity<si::time, Real> h) {
    { f.after(v, h).force } -> std::convertible_to<quantity_of<Out, Real>>;
    { f.after(v, h).slope } -> std::convertible_to<gain_of<Out, In, Real>>;
    changed.become(f.after(v, h).next);
    { f.now() } -> std::convertible_to<typename F::state>;
    changed.reset();
};

/// Where an axis on such a law is after a step.
template <class State, class Real, signal_tag In = signal::velocity> struct presliding_outcome {
    quantity_of<In, Real> v{};
    State friction{};
};

namespace detail {
/// A law that says its force at v = 0 without a step, to the bit that of after(0, h).
template <class F, class Real, class Out>
concept tells_force_at_rest = std::floating_point<Real> && requires(const F& f) {
    { f.at_rest() } -> std::convertible_to<quantity_of<Out, Real>>;
};
} // namespace detail

/// Velocity v' after one step h of M dv/dt = drive - friction, the friction that of the end of the step:
///   M (v' - v)/h + after(v', h).force = drive
/// Each law solves its own equation exactly for a velocity that is constant over h; which velocity that is, is
/// found here implicitly. So a stiff contact neither rings nor needs a small h, and no step adds energy.
/// Newton's method from v, kept between rest and the far side of the solution: 2 to 4 passes, one or two more
/// where an element breaks away; to 2e-14 of the speeds in it (float: 3e-7). The derivatives of a dual take one
/// more. Where several v' solve it, one near v is taken.
/// Derivation: docs/derivations/presliding.md.
/// In and Out: velocity and force, or angular velocity and torque (the mass is a moment of inertia then).
template <class Real, signal_tag In = signal::velocity, signal_tag Out = signal::force,
          friction_with_memory<Real, In, Out> Friction>
auto presliding(
    const Friction& friction,
    quantity<unit_quotient<typename Out::unit, unit_quotient<typename In::unit, si::time>>, Real> mass,
    quantity_of<In, Real> v, quantity_of<Out, Real> drive, quantity<si::time, Real> h) noexcept {
    using velocity = quantity_of<In, Real>;
    using force = quantity_of<Out, Real>;
    using outcome = presliding_outcome<typename Friction::state, Real, In>;
    const gain_of<Out, In, Real> inertia = mass / h;
    const force push = force(inertia * v) + drive; // what would bring the axis to rest within h, and the drive
    const auto size = [](velocity x) { return x < velocity() ? -x : x; };

    constexpr bool told = detail::tells_force_at_rest<Friction, Real, Out>;
    decltype(friction.after(velocity(), h)) at;
    force missing = push;
    if constexpr (told) // an axis that moves on its way needs no more of rest than this
        missing -= friction.at_rest();
    else {
        at = friction.after(velocity(), h);
        missing -= at.force;
    }
    const auto from_rest = [&] {
        if constexpr (told) at = friction.after(velocity(), h);
        return missing / (inertia + at.slope); // the solution while nothing breaks away
    };
    if (!finite(missing))
        return outcome{missing / inertia, friction.after(velocity(), h).next}; // for the plant
    if (missing == force()) {                                                  // zero, and its derivatives
        const velocity linear = from_rest();
        return outcome{linear, friction.after(linear, h).next};
    }
    const bool forward = missing > force();
    const auto beyond = [forward](velocity a, velocity b) { return forward ? a > b : a < b; };

    velocity near{}, far{}; // the solution lies between, once far is known
    bool bounded = false;
    velocity x = beyond(v, near) ? v : from_rest();
    const Real close = Real(detail::newton_accuracy<Real>);
    constexpr int most_passes = 80; // seen: up to 20, but for a jump at rest, which is halved to nothing
    for (int pass = 0; pass < most_passes; ++pass) {
        at = friction.after(x, h);
        const force excess = inertia * x + at.force - push;
        const gain_of<Out, In, Real> slope = inertia + at.slope;
        const velocity step = excess / slope, next = x - step;
        const bool newton = slope > decltype(slope)() && beyond(next, velocity());
        if (newton && size(step) <= close * (size(x) + size(push / slope))) {
            if constexpr (std::floating_point<Real>) return outcome{x, at.next};
            x = next; // carries the derivatives
            break;
        }
        if (forward ? excess < force() : excess > force())
            near = x;
        else {
            far = x;
            bounded = true;
        }
        if (bounded && size(far - near) <= close * size(near)) break; // a jump of the law
        if (newton && beyond(next, near) && (!bounded || beyond(far, next)))
            x = next;
        else
            x = bounded ? (near + far) * Real(0.5) : x * Real(2);
    }
    return outcome{x, friction.after(x, h).next};
}

} // namespace quadrant::inline v0
