// SPDX-License-Identifier: BSL-1.0
// Long: one loop: its step and its verbs, each of them in the order of the same wires.
#pragma once
#include "../base/finite.hpp"
#include "../block/axis_motion.hpp"
#include "../block/maps.hpp"
#include "../block/taps.hpp"
#include "milling_slots.hpp"

#include <tuple>
#include <type_traits>

namespace quadrant::inline v0 {

/// The axis of the milling table: P on position, PI on velocity with the notch in the velocity feedback, the
/// inverse of the plant and its friction fed forward, a disturbance observer, a memory of what the error was a
/// cycle ago. The second worked loop beside `cascade`, from the same boxes; for another diagram copy the body
/// and redraw it.
///   e = r - y,   v = position_loop(e + memory(e)) + notch(Vest r) - notch(Vest y)
///   u = PI(v) + (r'' + A r')/B - d(y, u) + friction(travel)
/// Source: [Jamaludin2008] eq. (2.10, 2.22-2.34) for the cascade, (3.5-3.8) friction, (4.1-4.20) observer, ch.
/// 5 memory.
/// Ports: reference (position, velocity, acceleration) and measured position in, command out (to act from this
/// sample on).
///   `ahead` is the reference at the moment when the command will act: the feedforward of plant and friction takes it.
///   Without preview it is the reference itself.
/// Signs: a friction box gives what has to be added, a disturbance box what has to be subtracted. Friction
/// enters behind the tap of the observer (wire.compensated): in front of it, it would be compensated twice; one
/// that learns (`maxwell_slip_observer`) is told what the observer is left with. A
/// `disturbance_observer` is fed this cycle's wish, a `harmonic_force_observer` what acted since the sample
/// before, a `ferraris_force_estimator` the measured acceleration and what acts at this sample, less the
/// friction that was fed forward: axis(reference, ahead, measured, acceleration). A memory box gives what is
/// added to the position error.
/// State: that of the boxes. `reset` as new (at rest at zero); `settle(x, u)` at rest at x, held by u (as far
/// as the limit allows), which the observer then carries, or the PI, and nothing learnt: the next sample at the
/// same place gives u again. `track`, `retune`, `shift`: enabled without a bump, other parameters while it
/// runs, homing; see docs/integrator.md.
/// NaN and infinities: returns the last command, no box moves, raises faulted() until reset or settle.
/// Cost: that of the boxes. limited() reports that the amplifier clipped; PI and observer learn what was
/// applied.
template <milling_boxes Boxes> struct milling_axis {
    using real = real_of_boxes<Boxes>;
    using position = quantity_of<signal::position, real>;
    using velocity = quantity_of<signal::velocity, real>;
    using acceleration = quantity_of<signal::acceleration, real>;
    using command = quantity_of<command_of<Boxes>, real>;
    using wires = milling_wires<command_of<Boxes>, real>;
    static_assert(every_wire_has_a_tap(
        milling_wires<command_of<Boxes>, std::conditional_t<multi_lane<real>, double, real>>::taps()));
    static_assert(!multi_lane<real> || steps_together<real>, "an axis holds as a whole: lanes_in_step");

    using motion = axis_motion<real>; ///< what the trajectory asks for at one moment
    /// True where the disturbance box wants the measured acceleration: every call then has to give it.
    static constexpr bool takes_acceleration =
        fed_the_acceleration<decltype(Boxes::disturbance), command_of<Boxes>, real>;

    Boxes box;
    wires wire{};
    bool fault = false;    ///< a sample was not finite; cleared by reset and settle
    bool tracking = false; ///< the last sample was a `track`: nothing is learnt

    [[gnu::always_inline]] command operator()(const motion& reference, position measured) noexcept
        requires(!takes_acceleration) {
        return step(reference, reference, measured);
    }
    [[gnu::always_inline]] command operator()(const motion& reference, const motion& ahead,
                                              position measured) noexcept requires(!takes_acceleration) {
        return step(reference, ahead, measured);
    }
    void
    operator()(const motion& reference, const motion& ahead,
               position measured) requires takes_acceleration = delete; // the measured acceleration is missing
    void operator()(const motion& reference, position measured) requires takes_acceleration =
        delete; // the motion ahead and the measured acceleration are missing
    [[gnu::always_inline]] command operator()(const motion& reference, const motion& ahead, position measured,
                                              acceleration accelerated) noexcept requires takes_acceleration {
        if (all(finite(accelerated))) return step(reference, ahead, measured, accelerated);
        fault = true;
        return wire.command;
    }

    void settle(position x, command hold = command()) noexcept {
        if (!all(finite(x, hold))) {
            fault = true;
            return;
        }
        wire = {};
        wire.reference = wire.measured = x;
        if constexpr (estimates_in_pair<Boxes>) {
            take(box.estimators.settle(x));
        } else {
            wire.reference_velocity =
                detail::settled(box.reference_notch, detail::settled(box.reference_velocity, x));
            wire.measured_velocity =
                detail::settled(box.measured_notch, detail::settled(box.measured_velocity, x));
        }
        forget();
        wire.demand = detail::settled(box.position_loop, wire.learned) + wire.reference_velocity;
        wire.velocity_error = wire.demand - wire.measured_velocity;
        wire.inertia = detail::settled(box.inertia, acceleration());
        wire.drag = detail::settled(box.drag, velocity());
        wire.travel = detail::settled(box.travel, x);
        wire.friction = detail::settled(box.friction, wire.travel);
        wire.compensated =
            hold - wire.friction; // held by the observer where one can be told so, else by the PI
        if constexpr (requires { box.disturbance.settle(x, hold); }) {
            wire.disturbance = -wire.compensated;
            box.disturbance.settle(x, wire.disturbance);
        } else if constexpr (takes_acceleration) {
            wire.disturbance = -wire.compensated;
            box.disturbance.settle(acceleration(), wire.compensated);
        } else
            wire.disturbance = detail::settled(box.disturbance, x);
        wire.linear = wire.compensated + wire.disturbance;
        carry();
        fault = false;
    }
    /// Output tracking, instead of a step, while the drive is off (applied = 0) or another controller has the
    /// axis: estimators, friction and observer see what happens and what was applied, the memory has learnt
    /// nothing, and the integral is what makes the next step give `applied` if no wire changes till then.
    void track(const motion& reference, position measured, command applied) noexcept
        requires(!takes_acceleration) {
        track(reference, reference, measured, applied, acceleration());
    }
    void track(const motion& reference, const motion& ahead, position measured, command applied) noexcept
        requires(!takes_acceleration) {
        track(reference, ahead, measured, applied, acceleration());
    }
    void track(const motion& reference, const motion& ahead, position measured, command applied,
               acceleration accelerated) noexcept {
        if (!all(finite(reference.position, ahead.position, ahead.velocity, ahead.acceleration, measured,
                        applied, accelerated))) {
            fault = true;
            return;
        }
        const command acted = last_applied();
        look(reference, measured);
        if (!tracking) forget();
        tracking = true;
        wire.demand = box.position_loop(wire.position_error + wire.learned) + wire.reference_velocity;
        wire.velocity_error = wire.demand - wire.measured_velocity;
        wire.inertia = box.inertia(ahead.acceleration);
        wire.drag = box.drag(ahead.velocity);
        wire.travel = box.travel(ahead.position);
        wire.friction = box.friction(wire.travel);
        wire.compensated = applied - wire.friction;
        wire.disturbance = estimate(measured, wire.compensated + wire.disturbance, acted, accelerated);
        if constexpr (requires { box.disturbance.applied(wire.compensated); })
            box.disturbance.applied(wire.compensated);
        if constexpr (requires { box.disturbance.disturbance(); })
            wire.disturbance = box.disturbance.disturbance();
        wire.linear = wire.compensated + wire.disturbance;
        carry();
    }
    /// Other parameters from the next step on, each box as its own retune says; `ahead` as in the last step.
    /// What gains and
    /// feedforward change goes into the integral: the last step, done once more, would give the same command.
    void retune(const Boxes& next, const motion& ahead) noexcept requires retunable_milling_boxes<Boxes> {
        detail::retune(box.memory, next.memory);
        detail::retune(box.position_loop, next.position_loop);
        if constexpr (estimates_in_pair<Boxes>) {
            box.estimators.retune(next.estimators);
        } else {
            detail::retune(box.reference_velocity, next.reference_velocity);
            detail::retune(box.reference_notch, next.reference_notch);
            detail::retune(box.measured_velocity, next.measured_velocity);
            detail::retune(box.measured_notch, next.measured_notch);
        }
        detail::retune(box.inertia, next.inertia);
        detail::retune(box.drag, next.drag);
        detail::retune(box.disturbance, next.disturbance);
        if constexpr (requires { box.disturbance.disturbance(); })
            wire.disturbance = box.disturbance.disturbance();
        detail::retune(box.travel, next.travel);
        detail::retune(box.friction, next.friction);
        detail::retune(box.amplifier, next.amplifier);
        detail::retune(box.dac, next.dac);
        wire.demand = box.position_loop(wire.position_error + wire.learned) + wire.reference_velocity;
        wire.velocity_error = wire.demand - wire.measured_velocity;
        wire.inertia = box.inertia(ahead.acceleration);
        wire.drag = box.drag(ahead.velocity);
        wire.friction = detail::foreseen(box.friction, wire.travel);
        wire.compensated = wire.wanted - wire.friction;
        wire.linear = wire.compensated + wire.disturbance;
        wire.feedback = wire.linear - wire.inertia - wire.drag;
        box.velocity_loop.retune(next.velocity_loop, wire.velocity_error, wire.feedback);
    }
    /// The frame of positions moves (homing): what is read and asked for is higher by so much from now on; no
    /// command changes.
    void shift(position by) noexcept requires shiftable_milling_boxes<Boxes> {
        if constexpr (estimates_in_pair<Boxes>) {
            box.estimators.shift(by);
        } else {
            box.reference_velocity.shift(by);
            box.measured_velocity.shift(by);
        }
        if constexpr (!takes_acceleration) box.disturbance.shift(by);
        box.travel.shift(by);
        wire.reference += by;
        wire.measured += by;
    }
    void reset() noexcept {
        std::apply([](auto&... each) { (each.reset(), ...); }, boxes(box));
        wire = {};
        fault = false;
    }

    bool limited() const noexcept { return !all(equal(wire.limited, wire.wanted)); }
    bool faulted() const noexcept {
        return fault ||
               std::apply([](const auto&... each) { return (detail::is_faulted(each) || ...); }, boxes(box));
    }

    static constexpr auto taps() { return wires::taps(); }

private:
    /// One function with all boxes in it, whatever the compiler would have left as calls.
    [[gnu::always_inline, gnu::flatten]] inline command step(const motion& reference, const motion& ahead,
                                                             position measured,
                                                             acceleration accelerated = {}) noexcept {
        if (!all(finite(reference.position, ahead.position, ahead.velocity, ahead.acceleration, measured))) {
            fault = true;
            return wire.command;
        }
        look(reference, measured);
        wire.learned = box.memory(wire.position_error);
        tracking = false;
        wire.demand = box.position_loop(wire.position_error + wire.learned) + wire.reference_velocity;
        wire.velocity_error = wire.demand - wire.measured_velocity;
        wire.feedback = box.velocity_loop(wire.velocity_error);
        wire.inertia = box.inertia(ahead.acceleration);
        wire.drag = box.drag(ahead.velocity);
        wire.linear = wire.feedback + wire.inertia + wire.drag;
        wire.disturbance = estimate(measured, wire.linear, last_applied(), accelerated);
        wire.compensated = wire.linear - wire.disturbance; // what the observer takes for applied
        wire.travel = box.travel(ahead.position); // mean velocity of the last period: friction counts path
        if constexpr (requires { box.friction(wire.travel, -wire.disturbance); })
            wire.friction =
                box.friction(wire.travel, -wire.disturbance); // it learns what the observer is left with
        else
            wire.friction = box.friction(wire.travel);
        wire.wanted = wire.compensated + wire.friction;
        wire.limited = box.amplifier(wire.wanted);
        wire.command = box.dac(wire.limited);
        // What was cut off is charged to the PI and to the observer, whoever asked for too much.
        if constexpr (requires { box.velocity_loop.applied(wire.feedback); })
            box.velocity_loop.applied(wire.feedback + (wire.limited - wire.wanted));
        if constexpr (requires { box.disturbance.applied(wire.compensated); })
            box.disturbance.applied(wire.compensated + (wire.command - wire.wanted));
        return wire.command;
    }
    [[gnu::always_inline, gnu::flatten]] inline void look(const motion& reference, position measured) noexcept {
        wire.reference = reference.position;
        wire.measured = measured;
        if constexpr (estimates_in_pair<Boxes>) {
            take(box.estimators(reference.position, measured));
        } else {
            wire.reference_velocity = box.reference_notch(box.reference_velocity(reference.position));
            wire.measured_velocity = box.measured_notch(box.measured_velocity(measured));
        }
        wire.position_error = reference.position - measured;
    }
    [[gnu::always_inline]] void take(const auto& velocities) noexcept {
        wire.reference_velocity = velocities.reference;
        wire.measured_velocity = velocities.measured;
    }
    void forget() noexcept { // one that integrates has to be told that it gives nothing
        wire.learned = position();
        if constexpr (requires { box.memory.settle(position(), position()); })
            box.memory.settle(position(), position());
        else
            wire.learned = detail::settled(box.memory, position());
    }
    void carry() noexcept {
        wire.feedback = wire.linear - wire.inertia - wire.drag;
        box.velocity_loop.settle(wire.velocity_error, wire.feedback);
        wire.wanted = wire.compensated + wire.friction;
        wire.limited = detail::settled(box.amplifier, wire.wanted);
        wire.command = detail::settled(box.dac, wire.limited);
    }
    /// What acted on the plant since the sample before, without the friction that was fed forward; before the
    /// wires of this sample.
    command last_applied() const noexcept { return wire.compensated + (wire.command - wire.wanted); } // z^-1
    [[gnu::always_inline, gnu::flatten]] inline command
    estimate(position measured, [[maybe_unused]] command wish, [[maybe_unused]] command acted,
             [[maybe_unused]] acceleration accelerated) noexcept {
        using observer = decltype(box.disturbance);
        if constexpr (takes_acceleration) {
            box.disturbance(accelerated, acted);
            return box.disturbance.command();
        } else if constexpr (fed_the_last_applied<observer>)
            return box.disturbance(measured, acted);
        else if constexpr (fed_the_wish<observer, command_of<Boxes>, real>)
            return box.disturbance(measured, wish);
        else
            return box.disturbance(measured);
    }
    static constexpr auto boxes(auto& b) noexcept {
        if constexpr (estimates_in_pair<Boxes>)
            return std::tie(b.memory, b.position_loop, b.estimators, b.velocity_loop, b.inertia, b.drag,
                            b.disturbance, b.travel, b.friction, b.amplifier, b.dac);
        else
            return std::tie(b.memory, b.position_loop, b.reference_velocity, b.reference_notch,
                            b.measured_velocity, b.measured_notch, b.velocity_loop, b.inertia, b.drag,
                            b.disturbance, b.travel, b.friction, b.amplifier, b.dac);
    }
};

} // namespace quadrant::inline v0
