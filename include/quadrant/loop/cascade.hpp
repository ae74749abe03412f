// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "../block/maps.hpp"
#include "../block/taps.hpp"
#include "cascade_slots.hpp"

#include <tuple>
#include <type_traits>

namespace quadrant::inline v0 {

/// The classical servo axis: P on position, PI on velocity, notch, feedforward, limit, DAC. A worked example
/// with a
/// concept, not a framework: for another diagram copy the body and redraw it.
///   v_ref = (r[k]-r[k-1])/T, a_ref = (v_ref[k]-v_ref[k-1])/T, e = position_gain (r-y) + velocity_feedforward v_ref - v
///   u = round(limit(notch(PI(e)) + acceleration_feedforward a_ref + friction(v_ref)))
/// Source: docs/formats.md, controller kind cascade_p_pi.
/// Ports: position reference and measured position in, command out (to act from this sample on).
/// State: that of the boxes. `reset` as new (at rest at zero). `settle(start)` is the bumpless start in the
/// middle of a
/// motion: the next row, if the motion goes on as `start` says, gives start.command (as far as the limits
/// allow). `track`, `retune`, `shift`: enabled without a bump, other parameters while it runs, homing; see
/// docs/integrator.md.
/// NaN and infinities: returns the last command, no box moves, raises faulted() until reset or settle.
/// Cost: that of the boxes. limited() reports that the amplifier clipped; the PI learns what was applied.
template <axis_boxes Boxes> struct cascade {
    using real = real_of_boxes<Boxes>;
    using position = quantity_of<signal::position, real>;
    using velocity = quantity_of<signal::velocity, real>;
    using acceleration = quantity_of<signal::acceleration, real>;
    using command = quantity_of<command_of<Boxes>, real>;
    using wires = cascade_wires<command_of<Boxes>, real>;
    using mask = mask_of<real>; ///< bool, but for lanes
    static_assert(every_wire_has_a_tap(
        cascade_wires<command_of<Boxes>, std::conditional_t<multi_lane<real>, double, real>>::taps()));

    Boxes box;
    wires wire{};
    mask fault{}; ///< a sample was not finite; cleared by reset and settle

    command operator()(position reference, position measured) noexcept {
        const auto good = finite(reference, measured);
        if (!all(good)) {
            fault = either(fault, !good);
            if (none(good)) return wire.command;
        }
        const auto before = wires_before();
        look(good, reference, measured);
        wire.feedback = box.velocity_loop(only_where(good, wire.velocity_error));
        wire.damped = box.resonance(only_where(good, wire.feedback));
        wire.inertia = box.acceleration_feedforward(only_where(good, wire.reference_acceleration));
        wire.friction = box.friction(only_where(good, wire.reference_velocity));
        wire.wanted = wire.damped + wire.inertia + wire.friction;
        wire.limited = box.amplifier(only_where(good, wire.wanted));
        wire.command = box.dac(only_where(good, wire.limited));
        // What was cut off is charged to the PI: it may wind up no further, whoever asked for too much.
        if constexpr (requires { box.velocity_loop.applied(wire.feedback); })
            box.velocity_loop.applied(wire.feedback + (wire.limited - wire.wanted));
        restore(good, before);
        return wire.command;
    }

    /// The last row before the next call: where the axis was, how it moved, what was commanded.
    struct start {
        position reference{}, measured{};
        velocity reference_velocity{}, measured_velocity{};
        acceleration reference_acceleration{};
        cascade::command command{};
    };
    void settle(start s) noexcept {
        const auto good = finite(s.reference, s.measured, s.reference_velocity, s.measured_velocity,
                                 s.reference_acceleration, s.command);
        fault = !good;
        if (none(good)) return;
        const auto before = wires_before();
        s = {only_where(good, s.reference),
             only_where(good, s.measured),
             only_where(good, s.reference_velocity),
             only_where(good, s.measured_velocity),
             only_where(good, s.reference_acceleration),
             only_where(good, s.command)};
        wire.reference = s.reference;
        wire.measured = s.measured;
        wire.reference_velocity = s.reference_velocity;
        wire.reference_acceleration = s.reference_acceleration;
        wire.measured_velocity = s.measured_velocity;
        box.reference_velocity.settle(s.reference, s.reference_velocity);
        box.reference_acceleration.settle(s.reference_velocity, s.reference_acceleration);
        box.measured_velocity.settle(s.measured, s.measured_velocity);
        wire.position_error = s.reference - s.measured;
        wire.demand = detail::settled(box.position_loop, wire.position_error) +
                      detail::settled(box.velocity_feedforward, s.reference_velocity);
        wire.velocity_error = wire.demand - s.measured_velocity;
        wire.inertia = detail::settled(box.acceleration_feedforward, s.reference_acceleration);
        wire.friction = detail::settled(box.friction, s.reference_velocity);
        carry(good, s.command);
        restore(good, before);
    }
    /// Output tracking, instead of a step, while the drive is off (applied = 0) or another controller has the
    /// axis: the estimators go on, the integral is what makes the next step give `applied` if no wire changes
    /// till then.
    void track(position reference, position measured, command applied) noexcept {
        const auto good = finite(reference, measured, applied);
        if (!all(good)) {
            fault = either(fault, !good);
            if (none(good)) return;
        }
        const auto before = wires_before();
        look(good, reference, measured);
        wire.inertia = box.acceleration_feedforward(only_where(good, wire.reference_acceleration));
        wire.friction = box.friction(only_where(good, wire.reference_velocity));
        carry(good, applied);
        restore(good, before);
    }
    /// Other parameters from the next step on, each box as its own retune says; what gains and feedforward
    /// change goes into
    /// the integral: the last step, done once more, would give the same command.
    void retune(const Boxes& next) noexcept requires retunable_axis_boxes<Boxes> {
        const command before = wire.inertia + wire.friction;
        detail::retune(box.reference_velocity, next.reference_velocity);
        detail::retune(box.reference_acceleration, next.reference_acceleration);
        detail::retune(box.measured_velocity, next.measured_velocity);
        detail::retune(box.position_loop, next.position_loop);
        detail::retune(box.velocity_feedforward, next.velocity_feedforward);
        detail::retune(box.resonance, next.resonance);
        detail::retune(box.acceleration_feedforward, next.acceleration_feedforward);
        detail::retune(box.friction, next.friction);
        detail::retune(box.amplifier, next.amplifier);
        detail::retune(box.dac, next.dac);
        wire.demand =
            box.position_loop(wire.position_error) + box.velocity_feedforward(wire.reference_velocity);
        wire.velocity_error = wire.demand - wire.measured_velocity;
        wire.inertia = box.acceleration_feedforward(wire.reference_acceleration);
        wire.friction = detail::foreseen(box.friction, wire.reference_velocity);
        const command less = before - (wire.inertia + wire.friction);
        wire.feedback += less;
        wire.damped += less;
        box.velocity_loop.retune(next.velocity_loop, wire.velocity_error, wire.feedback);
        box.resonance.shift(less);
    }
    /// The frame of positions moves (homing): what is read and asked for is higher by so much from now on; no
    /// command changes.
    void shift(position by) noexcept requires shiftable_axis_boxes<Boxes> {
        box.reference_velocity.shift(by);
        box.measured_velocity.shift(by);
        wire.reference += by;
        wire.measured += by;
    }
    void reset() noexcept {
        std::apply([](auto&... each) { (each.reset(), ...); }, boxes(box));
        wire = {};
        fault = mask();
    }

    bool limited() const noexcept { return any(!equal(wire.limited, wire.wanted)); }
    bool faulted() const noexcept {
        return any(fault) ||
               std::apply([](const auto&... each) { return (detail::is_faulted(each) || ...); }, boxes(box));
    }

    /// Which lanes have a fault; a bool for a loop without lanes.
    mask faulted_lanes() const noexcept {
        mask out = fault;
        std::apply([&](const auto&... each) { ((out = either(out, each.faulted_lanes())), ...); }, boxes(box));
        return out;
    }

    static constexpr auto taps() { return wires::taps(); }

private:
    /// For lanes only: the wires as they were, and back to them in the lanes that are not good.
    auto wires_before() const noexcept {
        if constexpr (multi_lane<real>)
            return wire;
        else
            return 0;
    }
    template <class Before> void restore(const mask& good, [[maybe_unused]] const Before& before) noexcept {
        if constexpr (multi_lane<real>)
            for (const auto& each : wires::taps())
                each.write(wire, select(good, each.read(wire), each.read(before)));
    }
    [[gnu::always_inline]] inline void look(const mask& good, position reference, position measured) noexcept {
        wire.reference = reference;
        wire.measured = measured;
        wire.reference_velocity = box.reference_velocity(only_where(good, reference));
        wire.reference_acceleration = box.reference_acceleration(only_where(good, wire.reference_velocity));
        wire.measured_velocity = box.measured_velocity(only_where(good, measured));
        wire.position_error = reference - measured;
        wire.demand = box.position_loop(only_where(good, wire.position_error)) +
                      box.velocity_feedforward(only_where(good, wire.reference_velocity));
        wire.velocity_error = wire.demand - wire.measured_velocity;
    }
    void carry(const mask& good, command u) noexcept {
        wire.feedback = u - wire.inertia - wire.friction; // the notch has gain one at standstill
        box.velocity_loop.settle(wire.velocity_error, only_where(good, wire.feedback));
        wire.damped = detail::settled(box.resonance, only_where(good, wire.feedback));
        wire.wanted = wire.damped + wire.inertia + wire.friction;
        wire.limited = detail::settled(box.amplifier, only_where(good, wire.wanted));
        wire.command = detail::settled(box.dac, only_where(good, wire.limited));
    }
    static constexpr auto boxes(auto& b) noexcept {
        return std::tie(b.reference_velocity, b.reference_acceleration, b.measured_velocity, b.position_loop,
                        b.velocity_feedforward, b.velocity_loop, b.resonance, b.acceleration_feedforward,
                        b.friction, b.amplifier, b.dac);
    }
};

} // namespace quadrant::inline v0
