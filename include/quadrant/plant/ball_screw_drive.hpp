// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "../filter/viscous_step.hpp"
#include "../friction/asymmetric_stribeck.hpp"
#include "../friction/presliding.hpp"
#include "../observer/nominal_plant.hpp"

#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

namespace detail {
/// The torque that starts an axis toward one direction: of a law that knows directions, or of one that does
/// not.
template <class Friction>
requires requires(const Friction& f) { f.breakaway(true); } || requires(const Friction& f) {
    f.breakaway();
}
constexpr auto breakaway(const Friction& friction, bool forward) noexcept {
    if constexpr (requires { friction.breakaway(forward); })
        return friction.breakaway(forward);
    else
        return friction.breakaway();
}
/// What a drive steps in the sub-steps of one period: the law's own form for that, if it has one, or the law.
template <class Friction> decltype(auto) in_held_steps(const Friction& law) noexcept {
    if constexpr (requires { law.in_held_steps(); })
        return law.in_held_steps();
    else
        return (law);
}
} // namespace detail

/// A friction law that a rotary drive can take: `asymmetric_stribeck`, `stribeck`, `coulomb_viscous` from
/// angular velocity to torque. slip(w) is a magnitude.
template <class F, class Real>
concept rotary_friction = requires(const F& f, quantity_of<signal::angular_velocity, Real> w) {
    { detail::breakaway(f, true) } -> std::convertible_to<quantity_of<signal::torque, Real>>;
    { f.slip(w) } -> std::convertible_to<quantity_of<signal::torque, Real>>;
    { f.viscous() } -> std::convertible_to<gain_of<signal::torque, signal::angular_velocity, Real>>;
};

/// The same with a memory: `dahl`, `lugre`, `maxwell_slip` from angular velocity to torque.
template <class F, class Real>
concept rotary_friction_with_memory = friction_with_memory<F, Real, signal::angular_velocity, signal::torque>;

/// Motor, screw and table of a feed drive as one rigid body on friction.
///   J dw/dt = Kt i + rg F - B w - T(w),   dx/dt = rg w,   rg = pitch / 2 pi
/// Each sub-step is the exact solution for the torque at its beginning (zero-order hold). Friction by the stick
/// rule of eq. (14): at rest it equals what is applied, up to breakaway in that direction; when w would change
/// its sign within a sub-step the drive stops there, and the stick rule decides on the rest of it. On a
/// friction with memory each sub-step is implicit (friction/presliding.hpp), and a resting drive yields as its
/// bristles do.
/// Source: [Yeung2006] eqs. (1-18).
/// Ports: motor current i[k] [A] in, held over the period; position [m] on the side of the table at sample k+1
/// out, before play, lead error and encoder, which are boxes of their own (`feed_drive`). A second argument [N]
/// is an external force on the table (cutting), held too. Positive current, force and motion agree.
/// State: position, velocity, what the friction remembers. `reset`: at rest at zero; `settle(x)`: at rest at x,
/// the friction relaxed.
/// Range: substeps 1 ... 1000. Friction is held within a sub-step: a first-order error. Angles are radians;
/// inertia and viscous friction are all that the motor feels, table and guideway included.
/// NaN and infinities in a current or force, or a motion beyond all numbers: holds the last position, keeps the
/// state, raises faulted().
/// Throws "ball_screw_drive.<field> = ...: must ..." for every field and the period; the friction box in its
/// own name.
/// Cost: 8 multiplications a sub-step and one friction (3 to 5 with memory). Linear motor: `linear_motor`.
template <class Friction = asymmetric_stribeck<>, class Real = double>
requires(rotary_friction<Friction, Real> ||
         rotary_friction_with_memory<Friction, Real>) class ball_screw_drive {
    static constexpr bool remembers = rotary_friction_with_memory<Friction, Real>;

public:
    using input = signal::current;
    using output = signal::position;
    using number = parameter_real<Real>; ///< of parameters
    using current = quantity_of<signal::current, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using force = quantity_of<signal::force, Real>;
    using argument = current;
    using value = position;

    /// Motor, inertia and friction at the screw, and the travel per turn.
    struct parameters {
        quantity<si::moment_of_inertia, number> inertia;                     ///< J; > 0
        gain_of<signal::torque, signal::angular_velocity, number> viscous{}; ///< B; >= 0
        gain_of<signal::torque, signal::current, number> torque_constant;    ///< Kt; > 0
        quantity_of<signal::position, number> pitch;                         ///< travel per turn; > 0
        typename Friction::parameters friction{};                            ///< of the friction box
        std::size_t substeps = 4;                                            ///< per servo period; 1 ... 1000
    };
    /// Position [m] and velocity [m/s] of the table.
    struct state {
        position x{};
        velocity v{};
    };

    ball_screw_drive(const parameters& p, duration period)
        : given_(checked(p, period)), friction_(p.friction, period),
          torque_constant_(in_real<Real>(p.torque_constant)), travel_(in_real<Real>(travel(p))) {
        const number h = number(period.value() / static_cast<double>(p.substeps)), J = p.inertia.value();
        number viscous = p.viscous.value();
        if constexpr (!remembers) viscous += number(friction_.viscous().value());
        const viscous_step<number> step(viscous / J, h);
        viscous_ = of<decltype(viscous_)>(p.viscous.value());
        inertia_ = of<decltype(inertia_)>(J + p.viscous.value() * h);
        h_ = of<decltype(h_)>(h);
        kept_ = Real(step.kept);
        way_kept_ = of<decltype(way_kept_)>(step.gained);
        gained_ = of<decltype(gained_)>(step.gained / J);
        way_gained_ = of<decltype(way_gained_)>(step.way / J);
    }

    /// Applies i from sample k on; returns the position of sample k+1.
    position operator()(current i, force external = force()) noexcept {
        const torque applied = torque_constant_ * i + travel_ * external;
        angular_velocity w = state_.v / travel_;
        angle turned{};
        if constexpr (remembers) {
            if (!finite(applied)) return out_.hold();
            const typename Friction::state memory = friction_.now(); // goes back there after a fault
            for (std::size_t n = 0; n < given_.substeps; ++n) yield(w, turned, applied);
            if (!finite(state_.x + travel_ * turned, w)) {
                friction_.become(memory);
                return out_.hold();
            }
        } else {
            auto&& law = detail::in_held_steps(friction_);
            for (std::size_t n = 0; n < given_.substeps; ++n)
                if (!advance(law, w, turned, applied))
                    break; // at rest, and so it stays: what is applied does not change
        }
        const state next{state_.x + travel_ * turned, unless_died_out(velocity(travel_ * w))};
        if (!finite(applied, next.x, next.v)) return out_.hold();
        state_ = next;
        return out_.keep(next.x);
    }
    void reset() noexcept { settle(position()); }
    void settle(position x) noexcept {
        if (!finite(x)) return out_.raise();
        state_ = {x, velocity()};
        if constexpr (remembers) friction_.reset();
        out_.reset(x);
    }

    /// Without friction: x/i = B / (s (s + A)).
    axis_model<signal::current, number> model() const {
        return {given_.torque_constant * travel(given_) / given_.inertia, given_.viscous / given_.inertia};
    }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }
    const Friction& friction() const noexcept { return friction_; } ///< its memory: friction().now()

private:
    using torque = quantity_of<signal::torque, Real>;
    using angular_velocity = quantity_of<signal::angular_velocity, Real>;
    using angle = quantity<si::plane_angle, Real>;
    template <class Number> using way_per_angle = quantity<unit_quotient<si::length, si::plane_angle>, Number>;

    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("ball_screw_drive.period", period);
        require_positive<Real>("ball_screw_drive.inertia", p.inertia);
        require_not_negative<Real>("ball_screw_drive.viscous", p.viscous);
        require_positive<Real>("ball_screw_drive.torque_constant", p.torque_constant);
        require_positive<Real>("ball_screw_drive.pitch", p.pitch);
        require(p.substeps >= 1 && p.substeps <= 1000, "ball_screw_drive.substeps",
                static_cast<double>(p.substeps), "must lie between 1 and 1000");
        return p;
    }
    static way_per_angle<number> travel(const parameters& p) {
        return p.pitch / quantity<si::plane_angle, number>::from_value(number(2 * std::numbers::pi));
    }
    template <class Quantity> static Quantity of(number q) { return Quantity::from_value(Real(q)); }
    /// One sub-step on a friction that moves with the drive. B counts at its end:
    /// (J + B h)(w' - w)/h + T = t - B w.
    void yield(angular_velocity& w, angle& turned, torque applied) noexcept {
        const auto to = presliding<Real, signal::angular_velocity, signal::torque>(
            friction_, inertia_, w, torque(applied - viscous_ * w), h_);
        friction_.become(to.friction);
        turned += (w + to.v) * (h_ * Real(0.5));
        w = to.v;
    }
    /// One sub-step; false when it ends at rest.
    template <class Law>
    bool advance(Law& law, angular_velocity& w, angle& turned, torque applied) const noexcept {
        if (w == angular_velocity()) return leave(w, turned, applied, Real(1));
        const bool forward = w > angular_velocity();
        const torque slip = law.slip(w), t = applied - (forward ? slip : -slip);
        const angular_velocity next = kept_ * w + gained_ * t;
        if (forward ? next < angular_velocity()
                    : next > angular_velocity()) { // stops on the way, evenly slower
            const Real share = Real(w / (w - next));
            turned += w * (h_ * (share * Real(0.5)));
            w = angular_velocity();
            return leave(w, turned, applied, Real(1) - share);
        }
        turned += w * way_kept_ + t * way_gained_;
        w = next;
        return true;
    }
    /// From rest, for a share of a sub-step: away, if what is applied exceeds the breakaway torque on its side.
    bool leave(angular_velocity& w, angle& turned, torque applied, Real share) const noexcept {
        const bool forward = applied > torque();
        const torque held = detail::breakaway(friction_, forward), size = forward ? applied : -applied;
        if (size <= held) return false;
        const torque t = (forward ? size - held : held - size) * share;
        w = gained_ * t;
        turned += way_gained_ * t * share;
        return true;
    }

    parameters given_;
    Friction friction_;
    gain_of<signal::torque, signal::current, Real> torque_constant_;
    way_per_angle<Real> travel_; ///< rg
    quantity<si::time, Real> h_, way_kept_;
    quantity<si::moment_of_inertia, Real> inertia_;                   ///< J + B h
    gain_of<signal::torque, signal::angular_velocity, Real> viscous_; ///< B
    Real kept_{};
    quantity<unit_quotient<si::angular_velocity, si::torque>, Real> gained_;
    quantity<unit_quotient<si::plane_angle, si::torque>, Real> way_gained_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
